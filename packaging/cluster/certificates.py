"""Write certificates for a Dask cluster of one run: ``certificates.py FOLDER``, for its owner alone.

The settings that Dask reads from the environment are printed, one ``NAME=VALUE`` a line.
"""

from __future__ import annotations

import sys
from pathlib import Path

from distributed.security import Security


def main() -> None:
    """Write authority, certificate and key, and print the settings."""
    folder = Path(sys.argv[1]).absolute()
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    folder.chmod(0o700)
    made = Security.temporary()
    for name, text in (
        ("ca.pem", made.tls_ca_file),
        ("cert.pem", made.tls_client_cert),
        ("key.pem", made.tls_client_key),
    ):
        (folder / name).unlink(missing_ok=True)
        (folder / name).touch(mode=0o600, exist_ok=False)
        (folder / name).write_text(text, encoding="ascii")
    prefix = "DASK_DISTRIBUTED__COMM__"
    print(f"{prefix}REQUIRE_ENCRYPTION=True")
    print(f"{prefix}TLS__CA_FILE={folder / 'ca.pem'}")
    for part in ("SCHEDULER", "WORKER", "CLIENT"):
        print(f"{prefix}TLS__{part}__CERT={folder / 'cert.pem'}")
        print(f"{prefix}TLS__{part}__KEY={folder / 'key.pem'}")


if __name__ == "__main__":
    main()
