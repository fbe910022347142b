# A part of try_install.sh, as root: a minimal Debian, to which nothing is added but the package and what it names.
base=$PWD/build/roots/$suite.base root=$PWD/build/roots/$suite
archives=$PWD/build/roots/archives
user=designer home=/home/$user

# end_inside NAME: ends what runs inside the root, and nothing else, by its name or, for '', all of it.
end_inside() {
    for process in /proc/[0-9]*; do
        [ "$(readlink "$process/root")" = "$root" ] || continue
        case $(cat "$process/comm" 2>/dev/null) in *"$1"*) kill "${process#/proc/}" 2>/dev/null ;; esac
    done
    sleep 2
}

leave() {
    [ -d "$root/proc/1" ] && end_inside ''
    for place in proc dev/shm var/cache/apt/archives; do
        mountpoint -q "$root/$place" && umount "$root/$place"
    done
}
trap leave EXIT
trap 'exit 130' INT TERM

make_base() {
    [ -e "$base/.whole" ] && return
    rm -rf "$base"; mkdir -p "$base"
    # From where this machine installs its own packages.
    mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' | head -n 1)
    say "making a minimal $suite in build/roots (once)"
    debootstrap --variant=minbase "$suite" "$base" "$mirror" >"$work/log" 2>&1 || { tail -n 5 "$work/log"; exit 2; }
    apt-config dump | grep -E '^Acquire::(http|https|Check)' >"$base/etc/apt/apt.conf.d/99here"
    printf '#!/bin/sh\nexit 101\n' >"$base/usr/sbin/policy-rc.d"; chmod 755 "$base/usr/sbin/policy-rc.d"
    chroot "$base" useradd --create-home --shell /bin/sh $user
    touch "$base/.whole"
}

make_root() {
    leave
    rm -rf --one-file-system "$root"; mkdir -p "$archives"
    cp -a "$base" "$root"
    mount -t proc proc "$root/proc" && mount -t tmpfs tmpfs "$root/dev/shm" &&
        mount --bind "$archives" "$root/var/cache/apt/archives" || { say "Cannot mount here: try --prefix."; exit 2; }
    cp "$work/見本 1.busk" "$work/person.ply" "$root$home/"
    cp "$deb" "$root/srv/busk.deb"
    chroot "$root" chown -R $user: $home
    apt update
}

in_root() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 "$@"; }
apt() { in_root DEBIAN_FRONTEND=noninteractive apt-get -qy --no-install-recommends "$@" >>"$work/apt.log" 2>&1; }
# as_user COMMAND...: one line for a shell, as the user that owns the home.
as_user() { in_root su - $user -c "export LC_ALL=C.UTF-8 DISPLAY=$screen LIBGL_ALWAYS_SOFTWARE=1 XDG_CURRENT_DESKTOP=GNOME; $*"; }
screen=

# Names of all files but those that apt, dpkg and man keep books in; of those under /etc what is in them, too.
listing() {
    in_root sh -c 'find / -xdev \( -path /proc -o -path /tmp -o -path /root -o -path /srv -o -path /home -o -path /var/cache/apt \
        -o -path /var/lib/apt -o -path /var/lib/dpkg -o -path /var/log -o -path /var/cache/debconf -o -path /var/cache/man -o -path /run \) \
        -prune -o -print | grep -vE "^/(dev/shm|etc/ld.so.cache|var/cache/ldconfig)" | sort
        find /etc -type f ! -name ld.so.cache ! -name "*-" -exec md5sum {} + | sort -k 2'
}
same_files() { diff "$work/$1" "$work/$2"; }

. $here/in_a_root_checks.sh
