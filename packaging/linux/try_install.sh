#!/bin/sh
# Installs the package in dist/ where nothing else is installed, uses it as its user would, and removes it again:
# `make package-test`. As root it makes a minimal Debian with debootstrap (kept under build/roots for the next time);
# otherwise, or with --prefix, it unpacks the package into a folder and runs it from there.
#     packaging/linux/try_install.sh [--prefix] [--suite bookworm] [--dist dist]
# One line a check; the exit code tells whether all went well.
set -u
cd "$(dirname "$0")/../.."
here=packaging/linux
. $here/checks.sh

suite=bookworm way=root dist=dist
[ "$(id -u)" = 0 ] && command -v debootstrap >/dev/null || way=prefix
while [ $# -gt 0 ]; do
    case $1 in
        --prefix) way=prefix ;;
        --suite) suite=$2; shift ;;
        --dist) dist=$2; shift ;;
        *) sed -n '2,6s/^# //p' "$0"; exit 2 ;;
    esac
    shift
done

python=.venv/bin/python
version=$($python -c 'import core; print(core.__version__)')
deb=$(ls "$dist"/busk_"$version"_*.deb) || { say "There is no package in $dist/: call make package first."; exit 2; }
archive=$(ls "$dist"/busk-"$version"-linux-*.tar.zst 2>/dev/null)
work=$PWD/build/try-install
rm -rf "$work" && mkdir -p "$work"
$python $here/sample_project.py "$work/見本 1.busk" || exit 2
cp resources/samples/person.ply "$work/person.ply"
# The answer of the source, to hold that of the installed program against.
.venv/bin/busk solve "$work/person.ply" --line mid-bust=95% --out "$work/source" >"$work/log" 2>&1 || exit 2

. $here/in_a_$way.sh
say "$checks checks, $failures failed"
[ "$failures" = 0 ]
