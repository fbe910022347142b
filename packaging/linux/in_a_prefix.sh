# A part of try_install.sh, without rights: the package is unpacked into a folder and run from there.
say "$deb, unpacked into a folder (nothing is installed; what it depends on must be here already)"
prefix="$work/a prefix"
export XDG_CONFIG_HOME="$work/config" XDG_DATA_HOME="$work/data" XDG_STATE_HOME="$work/state" XDG_CACHE_HOME="$work/cache"
busk="$prefix/usr/bin/busk"

check "unpacks" dpkg-deb -x "$deb" "$prefix"
check "names its version" says "busk $version" "$busk" --version
check "finds every library" says "" sh -c "cd '$prefix/usr/lib/busk' && [ -z \"\$($FIND_LIBRARIES)\" ]"
check "tests itself" "$busk" self-test
check "solves a scan" "$busk" solve "$work/person.ply" --line mid-bust=95% --out "$work/installed"
check "with the source's answer" $python $here/same_answer.py "$work/source" "$work/installed"
if command -v man >/dev/null; then
    check "has a manual page" says "busk solve" man -l "$prefix/usr/share/man/man1/busk.1.gz"
fi
if [ -n "$archive" ]; then
    mkdir -p "$work/other place"
    check "the portable archive unpacks" tar --zstd -xf "$archive" -C "$work/other place"
    check "and tests itself" sh -c "'$work/other place'/busk-*/busk/busk self-test"
fi
