#!/usr/bin/env bash
# The Debian packages on a clean Debian 12: apt installs them with what they depend on, a project is built with them, the
# program runs. As root, with a network.
#   clean_root.sh [PACKAGES]   a folder of .deb files; without it ./lagroid package makes them
# LAGROID_MIRROR: of Debian; LAGROID_CLEAN_ROOT: the folder it works in (2 GB), removed in the end.
set -euo pipefail
tests=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
mirror=${LAGROID_MIRROR:-http://deb.debian.org/debian}
work=${LAGROID_CLEAN_ROOT:-/var/tmp/lagroid_clean_root}
root=$work/root
say() { printf 'clean_root: %s\n' "$*" >&2; }
fail() {
  say "$*"
  exit 1
}

[ "$(id -u)" -eq 0 ] || fail "needs root, for debootstrap and chroot"
command -v debootstrap >/dev/null || fail "needs debootstrap: apt-get install debootstrap"
packages=${1:-}
if [ -z "$packages" ]; then
  "$tests/../lagroid" package >&2
  packages=$tests/../build/package
fi
ls "$packages"/*.deb >/dev/null || fail "no packages in $packages"

# Its own mounts end with it.
inside() { unshare --mount --fork sh -c 'mount -t proc proc "$0/proc" && exec chroot "$@"' "$root" "$root" "$@"; }

rm -rf "$work"
mkdir -p "$work"
trap 'rm -rf "$work"' EXIT
say "a clean Debian 12 from $mirror"
debootstrap --variant=minbase bookworm "$root" "$mirror" >"$work/debootstrap.log" || fail "$(tail -n 3 "$work/debootstrap.log")"
mkdir -p "$root/packages" "$root/tests"
cp "$packages"/*.deb "$root/packages"
cp -r "$tests/consumer" "$tests/installed_package.sh" "$root/tests"

install() { inside env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "$@" >>"$work/apt.log" 2>&1 ||
  fail "apt-get install $*: $(tail -n 5 "$work/apt.log")"; }
inside apt-get update -q >"$work/apt.log"

# The program before anything else, so that nothing but its own dependencies helps it.
install "$(inside sh -c 'ls /packages/lagroid_*.deb')"
inside lagroid run /usr/share/lagroid/examples/kepler.toml --out /tmp/kepler >"$work/run.log" || fail "$(cat "$work/run.log")"
for file in trajectory.h5 trajectory.csv summary.json plot.svg plot.png; do
  [ -s "$root/tmp/kepler/$file" ] || fail "the run wrote no $file"
done
inside lagroid cite /tmp/kepler >/dev/null
inside lagroid check --help >/dev/null || fail "lagroid-check is not there"
say "the program runs"

install "$(inside sh -c 'ls /packages/liblagroid-dev_*.deb')"
install g++ cmake make pkg-config librapidcheck-dev
inside /tests/installed_package.sh /usr /tmp/consumer whole || fail "the consumer project does not build or run"
say "the consumer project runs"

if inside sh -c 'ls /packages/python3-lagroid_*.deb' >/dev/null 2>&1; then
  install "$(inside sh -c 'ls /packages/python3-lagroid_*.deb')" python3-matplotlib python3-nbclient python3-ipykernel
  inside python3 -c 'import lagroid; print(lagroid.__version__)' || fail "the Python module is not imported"
  cp "$tests/../python/notebooks/run.py" "$root/tests/run_notebook.py"
  for example in "$root"/usr/share/lagroid/python/notebooks/*.ipynb; do
    inside python3 /tests/run_notebook.py "${example#"$root"}" >"$work/python.log" 2>&1 ||
      fail "${example#"$root"}: $(tail -n 5 "$work/python.log")"
  done
  say "the notebooks run"
else
  say "there is no Python package; nothing is asked of one"
fi
say "holds"
