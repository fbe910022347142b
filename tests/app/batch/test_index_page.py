"""The page of a run needs no network, shows the doubtful first and takes no name for a part of itself."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from app.batch.batch_design import batch_design
from app.batch.store import ResultStore
from core.document.design import Design, ScanSource

DESIGN = batch_design("<b>&", Design(ScanSource("")), ["mid-bust=95%"], [], [])
HOSTILE = "</script><script>alert(1)</script>.ply"


def row(scan: str, state: str = "done", **values: Any) -> dict[str, Any]:
    return {"scan": scan, "scan_sha256": scan, "variant": "<b>&", "state": state, **values}


@pytest.fixture
def page(tmp_path: Path) -> str:
    store = ResultStore(tmp_path, [DESIGN])
    good = [row(f"{at}.ply", verdict="good", bust_mm=800.0 + 10.0 * at, body_file="") for at in range(5)]
    bad = row("bad.ply", verdict="bad", bust_mm=950.0, body_file="bodies/bad.ply")
    store.add([*good, row(HOSTILE, "refused", message="Not a scan."), bad])
    store.finish([], 1.0, interrupted=False)
    store.close()
    return (tmp_path / "index.html").read_text("utf-8")


def data_of(page: str) -> dict[str, Any]:
    match = re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    assert match is not None
    values: dict[str, Any] = json.loads(match[1])
    return values


def test_the_doubtful_come_first(page: str) -> None:
    values = data_of(page)
    scans = [each[values["columns"].index("scan")] for each in values["rows"]]
    assert scans[:2] == [HOSTILE, "bad.ply"]
    assert len(scans) == 7
    assert values["files"][1] == {"body": "bodies/bad.ply", "picture": "", "report": ""}
    assert "1 bad, 5 good, 1 refused" in page


def test_nothing_comes_from_elsewhere_or_from_a_name(page: str) -> None:
    assert not re.search(r"https?:|src=|@import|url\(", page)
    assert "default-src 'none'" in page
    assert HOSTILE not in page
    assert "&lt;b&gt;&amp;" in page
    assert page.count("</script>") == 2


def test_distributions_have_mean_and_bars(page: str) -> None:
    figure = re.search(r'<figure><svg [^>]*aria-label="Bust \[mm\]: mean (\S+),.*?</figure>', page)
    assert figure is not None
    assert float(figure[1]) == pytest.approx((4100.0 + 950.0) / 6.0, abs=0.1)
    heights = [float(each) for each in re.findall(r'<rect [^>]*height="([\d.]+)"', figure[0])]
    assert sum(heights) == pytest.approx(6.0 * min(filter(None, heights)), abs=1.0), "one bar a body, or more"


def test_an_empty_run_has_a_page(tmp_path: Path) -> None:
    store = ResultStore(tmp_path, [DESIGN])
    store.finish([], 1.0, interrupted=True)
    store.close()
    assert data_of((tmp_path / "index.html").read_text("utf-8"))["rows"] == []
