#!/bin/sh
# Packs dist/Busk.app as people expect it: an image with the program beside a link to Applications, and its checksum.
set -eu
cd "$(dirname "$0")/../.."
version=$(.venv/bin/python -c 'from core import __version__; print(__version__)')
image=busk-$version-macos-arm64.dmg
inside=$(mktemp -d)
trap 'rm -rf "$inside"' EXIT
ditto dist/Busk.app "$inside/Busk.app"
ln -s /Applications "$inside/Applications"
hdiutil create -volname "Busk $version" -srcfolder "$inside" -fs HFS+ -format ULFO -ov "dist/$image"
(cd dist && shasum -a 256 "$image" > SHA256SUMS-macos)
