"""glTF files that keep what they describe in files beside them: what is taken of these, and what it costs."""

import base64
import json
import os
import tracemalloc

import numpy as np
import pytest
from scan_files import HOUSES, gltf

from core.errors import ScanError
from core.progress import Cancelled
from core.scan.readers.registry import read_raw, scan_bytes


def test_a_gltf_file_is_read_with_the_file_beside_it_and_with_no_other(tmp_path):
    text = json.loads(gltf(binary=False))
    content = base64.b64decode(text["buffers"][0]["uri"].partition(",")[2])
    folder = tmp_path / "scan"
    folder.mkdir()
    for place in (folder, tmp_path):
        (place / "the house.bin").write_bytes(content)
    (folder / "link.bin").symlink_to(tmp_path / "the house.bin")

    def read(uri):
        text["buffers"][0]["uri"] = uri
        (folder / "house.gltf").write_text(json.dumps(text))
        return read_raw("house.gltf", scan_bytes(folder / "house.gltf"))

    assert np.array_equal(read("the%20house.bin").faces, read_raw("a.gltf", HOUSES["text.gltf"]).faces)
    outside = (
        "../the house.bin",
        "..%2Fthe house.bin",
        str(tmp_path / "the house.bin"),
        "link.bin",
        "no.bin",
        "..",
    )
    for uri in outside:
        with pytest.raises(ScanError, match="in another file"):
            read(uri)


def split_gltf(folder, spare=b""):
    """Write the house with each part of its buffer in a file of its own; return how they are written."""
    text = json.loads(gltf(binary=False))
    content = base64.b64decode(text["buffers"][0]["uri"].partition(",")[2])
    text["buffers"] = []
    for k, view in enumerate(text["bufferViews"]):
        part = content[view["byteOffset"] :][: view["byteLength"]]
        (folder / f"{k}.bin").write_bytes(part + spare)
        view |= {"buffer": k, "byteOffset": 0}
        text["buffers"].append({"uri": f"{k}.bin", "byteLength": len(part)})
    (folder / "house.gltf").write_text(json.dumps(text))
    return text


def test_of_files_beside_a_gltf_file_no_more_is_taken_than_it_uses(tmp_path):
    split_gltf(tmp_path, b"something else altogether")
    data = scan_bytes(tmp_path / "house.gltf")
    found, whole = read_raw("house.gltf", data), read_raw("a.gltf", HOUSES["text.gltf"])
    assert b"something" not in data
    assert np.array_equal(found.vertices, whole.vertices)
    assert np.array_equal(found.faces, whole.faces)


def test_files_beside_a_gltf_file_are_held_once_and_not_read_when_nobody_wants_them(tmp_path):
    text = split_gltf(tmp_path)
    size = 20_000_000
    text["buffers"][0]["byteLength"] = size
    (tmp_path / "house.gltf").write_text(json.dumps(text))
    with pytest.raises(ScanError, match=r"0\.bin is truncated"):
        scan_bytes(tmp_path / "house.gltf")
    os.truncate(tmp_path / "0.bin", size)
    tracemalloc.start()
    try:
        assert len(scan_bytes(tmp_path / "house.gltf")) > size
        assert tracemalloc.get_traced_memory()[1] < 2 * size + 4_000_000
    finally:
        tracemalloc.stop()

    def stop(*_):
        raise Cancelled

    with pytest.raises(Cancelled):
        scan_bytes(tmp_path / "house.gltf", stop)
