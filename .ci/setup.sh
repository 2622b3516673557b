#!/bin/bash
# Installs the Debian packages that Tenon needs and that are missing. Quiet when nothing is missing.
#
#   .ci/setup.sh build   what building and the demo need
#   .ci/setup.sh test    these, and what the tests and checks add
#   .ci/setup.sh full    these, and what a release's tests add
#   .ci/setup.sh fuzz    what the tests need, and what the fuzzers add
#   .ci/setup.sh page    what makes the pages' bundle of libraries anew
set -euo pipefail

build_packages=(
  build-essential cmake ninja-build ccache
  libeigen3-dev libode-dev liblcm-dev liblcm-bin libncurses-dev libmicrohttpd-dev
  libyaml-cpp-dev liburdfdom-dev libconsole-bridge-dev libcli11-dev nlohmann-json3-dev
)
test_packages=(
  libgtest-dev libgmock-dev libbenchmark-dev liborocos-kdl-dev libfcl-dev
  clang-format clang-tidy cppcheck git python3 python3-can python3-numpy python3-serial iproute2
  python3-jsonschema python3-yaml python3-pyte util-linux can-utils qemu-system-x86 busybox-static cpio chromium rt-tests
)
full_packages=(mmdebstrap lintian)
fuzz_packages=(clang)
page_packages=(nodejs npm)

case "${1:-}" in
  build) packages=("${build_packages[@]}") ;;
  test) packages=("${build_packages[@]}" "${test_packages[@]}") ;;
  full) packages=("${build_packages[@]}" "${test_packages[@]}" "${full_packages[@]}") ;;
  fuzz) packages=("${build_packages[@]}" "${test_packages[@]}" "${fuzz_packages[@]}") ;;
  page) packages=("${page_packages[@]}") ;;
  *)
    echo "usage: .ci/setup.sh build|test|full|fuzz|page" >&2
    exit 2
    ;;
esac

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "setup: this is not a Debian-like system; please install the equivalents of:" \
    "${packages[*]}" >&2
  exit 1
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)
  # A package of several architectures prints one word for each.
  [[ $status == installed* ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
  exit 0
fi

if ((EUID == 0)); then
  as_root=()
elif command -v sudo >/dev/null && { [[ -t 0 ]] || sudo --non-interactive true 2>/dev/null; }; then
  as_root=(sudo)
else
  echo "setup: packages are missing, and installing them needs root or sudo. Please run:" >&2
  echo "  apt-get update && apt-get install --yes --no-install-recommends ${missing[*]}" >&2
  exit 1
fi

echo "setup: installing with apt-get: ${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get --quiet --quiet --option Dpkg::Use-Pty=0 --option DPkg::Lock::Timeout=300 "$@" \
    </dev/null >"$log" 2>&1
}
if ! { apt update && apt install --yes --no-install-recommends "${missing[@]}"; }; then
  cat "$log" >&2
  echo "setup: apt-get failed; its output stands above" >&2
  exit 1
fi
