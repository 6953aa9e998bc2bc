# What the two checks share: a clean Debian 12 in a folder, and the packages in its /packages. To be sourced.
#   make_debian ARGUMENTS: [--root DIR] [FOLDER]   FOLDER: of the packages (default build/release/packages)
#                          --root DIR: the Debian is made there and stays; one that is there is used again
# shellcheck shell=sh

step() { echo "== $*"; }
fail() { echo "FAILED: $*" >&2; exit 1; }
refuse() { echo "${0##*/}: $*" >&2; exit 2; }

services="capture perception pose intention ui-bridge"
export services

make_debian() {
  packages=$(dirname "$0")/../build/release/packages
  root=""
  temporary=no
  while [ $# -gt 0 ]; do
    case $1 in
      --root) [ $# -ge 2 ] || refuse "--root: expected a folder"; root=$2; shift 2 ;;
      -*) refuse "unknown option $1" ;;
      *) packages=$1; shift ;;
    esac
  done
  ls "$packages"/beckon_*.deb >/dev/null 2>&1 || refuse "no packages in $packages; 'make package' makes them"
  [ "$(id -u)" -eq 0 ] || refuse "needs root, to make a Debian to install in"
  command -v mmdebstrap >/dev/null || refuse "needs mmdebstrap (apt-get install mmdebstrap)"
  if [ -z "$root" ]; then
    root=$(mktemp -d)
    temporary=yes
    trap forget_debian EXIT
    trap 'exit 1' INT TERM
  fi
  if [ ! -x "$root/usr/bin/dpkg" ]; then
    step "a Debian 12 with apt and nothing else"
    mmdebstrap --quiet --variant=apt bookworm "$root"
    chmod 755 "$root"
  fi
  rm -rf "$root/packages"
  mkdir "$root/packages"
  cp "$packages"/*.deb "$root/packages/"
  cp -L /etc/resolv.conf "$root/etc/resolv.conf"
}

# Nothing is mounted in it any more when its namespace is gone; if something is, that stays.
forget_debian() { [ "$temporary" = no ] || rm -rf --one-file-system "$root"; }

# inside COMMAND: in the Debian, with nothing of this machine's environment
inside() {
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive chroot "$root" "$@"
}

# install WHAT: packages, or files as the Debian's shell finds them; says nothing unless it fails
install() {
  inside sh -c "apt-get -qq update
    apt-get -qq -o Dpkg::Use-Pty=0 install -y --no-install-recommends $* >/tmp/log 2>&1 || { cat /tmp/log >&2; exit 1; }"
}
