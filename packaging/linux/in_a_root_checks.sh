# A part of try_install.sh: what is done with the package in the minimal Debian of in_a_root.sh.
installed() { [ "$(in_root dpkg-query -W -f '${db:Status-Status} ${Version}' busk 2>/dev/null)" = "installed $1" ]; }
# What it brought goes, too, though something that was here before may suggest it.
removed() {
    apt purge busk &&
        apt -o APT::AutoRemove::RecommendsImportant=false -o APT::AutoRemove::SuggestsImportant=false autoremove --purge
}

without_a_display() {
    listing >"$work/at first"
    check "installs with what it depends on, and nothing else" apt install /srv/busk.deb
    check "is known to dpkg as $version" installed "$version"
    check "every library finds those it is linked to" in_root sh -c "cd /usr/lib/busk && [ -z \"\$($FIND_LIBRARIES)\" ]"
    check "files belong to root, nobody else may write" in_root sh -c \
        '[ -z "$(dpkg -L busk | xargs -d "\n" -I{} find {} -maxdepth 0 \( ! -user root -o ! -group root -o -perm /022 ! -type l \))" ]'
    check "no file was changed since it was packed" says "" in_root sh -c '[ -z "$(dpkg --verify busk)" ]'
    check "names its version" says "busk $version" as_user busk --version
    check "tests itself" as_user busk self-test
    sed 's/^/        /' "$work/log"
    check "solves a scan" as_user "busk solve person.ply --line mid-bust=95% --out installed"
    check "with the source's answer" $python $here/same_answer.py "$work/source" "$root$home/installed"
    check "measures a project" as_user "busk measure '見本 1.busk' --csv"
    check "runs where the home cannot be written to" in_root su $user -s /bin/sh -c \
        "cd /; export HOME=/nowhere; busk detect $home/person.ply --json"
    check "says in a sentence that there is no display" says "no display" as_user busk
    if [ -n "$archive" ]; then
        mkdir "$root$home/other place"
        tar --zstd -xf "$archive" -C "$root$home/other place" && chroot "$root" chown -R $user: $home
        check "the portable archive tests itself, in a place with a space" as_user "other\\ place/busk-*/busk/busk self-test"
    fi
    check "is removed with what it brought" removed
    listing >"$work/afterwards"
    check "leaves nothing but what is the user's own" same_files "at first" afterwards
    in_root find $home -mindepth 2 -maxdepth 3 -path '*/.*' -ipath '*busk*' | sed 's/^/        stays: /'
}

helpers="xvfb xauth xdotool x11-utils scrot xdg-utils libglib2.0-bin shared-mime-info desktop-file-utils
    hicolor-icon-theme man-db"

has_display() {
    for _ in $(seq 60); do
        [ -S "$root/tmp/.X11-unix/X77" ] && kill -0 "$display" && return 0
        sleep 0.5
    done
    cat "$work/xvfb.log"
    return 1
}

see() { in_root su - $user -c "DISPLAY=$screen scrot -o /tmp/shot.png" && cp "$root/tmp/shot.png" "$dist/$1"; }

# waits_for NAME: until a window of that name is there, at most a minute.
waits_for() {
    for _ in $(seq 120); do
        as_user "xdotool search --onlyvisible --name '$1'" >/dev/null 2>&1 && return 0
        sleep 0.5
    done
    as_user "xdotool search --name '' getwindowname %@"
    return 1
}

# opens HOW NAME PICTURE: starts Busk, waits for the window's name, lets it settle, takes a picture, closes it.
opens() {
    as_user "$1" >"$work/window.log" 2>&1 &
    waits_for "$2" || { cat "$work/window.log"; end_inside busk; return 1; }
    sleep 12
    see "$3" && as_user "xprop -name '$2' WM_CLASS _GTK_APPLICATION_ID" | tr '\n' ' '
    end_inside busk
}

on_a_display() {
    say "helpers are added (a display, what desktops bring): only now, so that they cannot stand in for a dependency"
    # shellcheck disable=SC2086  # one word a package
    apt install $helpers || { say "helpers cannot be installed"; tail -n 5 "$work/apt.log"; exit 2; }
    listing >"$work/at first"
    chroot "$root" Xvfb :77 -screen 0 1600x1000x24 -noreset -nolisten tcp >"$work/xvfb.log" 2>&1 &
    display=$! screen=:77
    check "a virtual display is there" has_display
    check "an older version installs" apt install /srv/older.deb
    check "is known as 0.0.1" installed 0.0.1
    check "the upgrade over it installs" apt install /srv/busk.deb
    check "is known as $version" installed "$version"
    check "a project has its type" says application/x-busk as_user "xdg-mime query filetype '見本 1.busk'"
    check "without its ending, too" says application/x-busk as_user \
        "cp 見本*.busk nameless; gio info -a standard::content-type nameless"
    check "Busk opens that type" says busk.desktop as_user "xdg-mime query default application/x-busk"
    printf '[Desktop Entry]\nType=Application\nName=Other\nExec=true %%f\nMimeType=model/stl;model/x-ply;model/obj;\n' \
        >"$root/usr/share/applications/viewer.desktop"
    in_root update-desktop-database
    for type in model/stl model/x-ply model/obj; do
        check "a viewer stays the one for $type" says viewer.desktop as_user "xdg-mime query default $type"
        check "and Busk is offered for $type" says busk-scan.desktop as_user "gio mime $type"
    done
    rm "$root/usr/share/applications/viewer.desktop"; in_root update-desktop-database
    check "has a manual page" says "busk solve" as_user "man busk"
    check "the menu entry opens the window" opens "gio launch /usr/share/applications/busk.desktop" \
        "mannequin - Busk" try-install-start.png
    check "a double click on a project opens it" opens "xdg-open '見本 1.busk'" "見本 1 - Busk" try-install.png
    as_user 'sed -i "/^language=/d" .config/Busk/Busk.conf; sed -i "1i [General]\nlanguage=ja" .config/Busk/Busk.conf'
    check "in Japanese, too" opens "busk '見本 1.busk'" "見本 1 - Busk" try-install-ja.png
    check "is removed" removed
    listing >"$work/afterwards"
    check "leaves nothing but what is the user's own" same_files "at first" afterwards
}

make_base
make_root
say "$deb in a minimal $suite"
$python $here/deb.py --program "$dist/busk" --version 0.0.1 --level 1 --out "$work/older" >>"$work/apt.log" 2>&1
mv "$work"/older/*.deb "$root/srv/older.deb"
without_a_display
on_a_display
