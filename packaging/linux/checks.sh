# Said and counted by try_install.sh.
checks=0 failures=0
say() { printf '%s\n' "$*"; }

# check WORDS COMMAND...: runs it, prints one line, and of what failed the end of what it said.
check() {
    words=$1; shift
    checks=$((checks + 1))
    if "$@" >"$work/log" 2>&1; then
        say "ok      $words"
    else
        failures=$((failures + 1))
        say "FAILED  $words"
        tail -n 12 "$work/log" | sed 's/^/        /'
    fi
}

# says TEXT COMMAND...: the command's answer holds the text.
says() {
    text=$1; shift
    answer=$("$@" 2>&1)
    printf '%s\n' "$answer"
    case $answer in *"$text"*) return 0 ;; esac
    echo "(no '$text' in it)"
    return 1
}

# Every shared library of a folder finds those that it is linked to; prints the ones that do not. Numba does without
# libtbb, as needs.py says.
FIND_LIBRARIES='find . -type f -name "*.so*" | while read -r file; do
    LD_LIBRARY_PATH=$PWD/_internal ldd "$file" 2>/dev/null | sed -n "s|\(.*\) => not found|$file: \1|p"; done | grep -v libtbb'
