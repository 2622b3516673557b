#!/bin/bash
# Boots Debian's own kernel under QEMU (in software, never KVM) and runs a command inside it: as root, on
# this machine's file system, which is read-only there; /run and $TMPDIR are the guest's own.
#
#   tests/guest/boot.sh COMMAND [ARGUMENT...]
#
# Exit status: the command's. A guest that hangs or dies is a failure and shows the end of its console.
# The kernel has CAN (tests/guest/modules) and two Kvaser controllers on one bus, can0 and can1. Its
# package is downloaded once into build/guest, and never installed. GUEST_LIMIT_S bounds the guest's life.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cache=$(dirname "$(dirname "$here")")/build/guest
limit_s=${GUEST_LIMIT_S:-600}

fail() {
  echo "guest: $*" >&2
  exit 1
}

# --- the kernel, unpacked ---------------------------------------------------------------------------

# The package that linux-image-amd64 stands for; its name carries the kernel's version.
package_name() {
  apt-cache depends linux-image-amd64 2>/dev/null |
    sed --quiet 's/^ *Depends: \(linux-image-[0-9].*\)$/\1/p' | head --lines 1
}

# Into a folder of its own first: a download that was cut short leaves no package behind.
download() {
  local name
  name=$(package_name)
  [[ -n $name ]] || return 1
  echo "guest: downloading $name"
  rm -rf "$cache/download"
  mkdir "$cache/download"
  (cd "$cache/download" && apt-get --quiet --option APT::Sandbox::User=root download "$name") \
    >"$cache/apt.log" 2>&1 && mv "$cache"/download/*.deb "$cache"
}

fetch_kernel() {
  compgen -G "$cache/linux-image-*.deb" >/dev/null && return
  local as_root=()
  ((EUID == 0)) || as_root=(sudo --non-interactive)
  download || { "${as_root[@]}" apt-get --quiet update >"$cache/apt.log" 2>&1 && download; } || {
    cat "$cache/apt.log" >&2
    fail "apt-get could not download Debian's kernel (linux-image-amd64); its output stands above." \
      "See that 'apt-get update' works here, or put a linux-image-*.deb into $cache"
  }
}

unpack_kernel() {
  local package patterns
  package=$(compgen -G "$cache/linux-image-*.deb" | sort --version-sort | tail --lines 1)
  [[ $cache/unpacked/done -nt $package && $cache/unpacked/done -nt $here/modules ]] && return
  rm -rf "$cache/unpacked"
  mkdir "$cache/unpacked"
  mapfile -t patterns < <(sed 's,.*,*/&.ko,' "$here/modules")
  dpkg-deb --fsys-tarfile "$package" |
    tar --extract --directory "$cache/unpacked" --wildcards './boot/vmlinuz-*' "${patterns[@]}" ||
    fail "$package lacks a module that the guest needs (above)"
  touch "$cache/unpacked/done"
}

# --- one run ----------------------------------------------------------------------------------------

make_initramfs() {
  local tree=$run/tree
  mkdir -p "$tree"/{bin,dev,proc,sys,root,modules}
  cp "$(command -v busybox)" "$tree/bin/busybox"
  install --mode 755 "$here/init" "$tree/init"
  cp "$here/modules" "$tree/modules/order"
  find "$cache/unpacked/lib" -name '*.ko' -exec cp {} "$tree/modules" \;
  (cd "$tree" && find . | cpio --quiet --create --format newc) >"$run/initramfs"
}

write_command() {
  cat >"$run/share/command" <<END
export PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin
export HOME=/run/tmp TERM=dumb TMPDIR=/run/tmp TEST_TMPDIR=/run/tmp
read -r up_s _ </proc/uptime
echo "guest: Linux \$(uname -r) up after \$up_s s"
cd $(printf '%q' "$PWD")
$(printf '%q ' "$@")
END
}

boot() {
  timeout --foreground --kill-after 5 "$limit_s" qemu-system-x86_64 \
    -accel tcg -machine pc -smp 1 -m 1024 -nodefaults -no-user-config -display none -no-reboot \
    -kernel "$(compgen -G "$cache/unpacked/boot/vmlinuz-*")" -initrd "$run/initramfs" \
    -append "console=ttyS0 panic=-1 quiet mitigations=off no_timer_check" \
    -serial "file:$run/console" -serial stdio \
    -fsdev local,id=root,path=/,security_model=none,readonly=on,multidevs=remap \
    -device virtio-9p-pci,fsdev=root,mount_tag=root \
    -fsdev local,id=share,path="$run/share",security_model=none \
    -device virtio-9p-pci,fsdev=share,mount_tag=share \
    -object can-bus,id=bus -device kvaser_pci,canbus=bus -device kvaser_pci,canbus=bus </dev/null
}

(($#)) || fail "usage: tests/guest/boot.sh COMMAND [ARGUMENT...]"
[[ $(dpkg --print-architecture) == amd64 ]] ||
  fail "the guest runs this machine's programs under an amd64 kernel; this machine is no amd64"
for program in qemu-system-x86_64 busybox cpio; do
  command -v "$program" >/dev/null || fail "$program is missing; run '.ci/setup.sh test'"
done
mkdir -p "$cache"
fetch_kernel
unpack_kernel

run=$(mktemp --directory "$cache/run.XXXXXX")
trap 'rm -rf "$run"' EXIT
mkdir "$run/share"
make_initramfs
write_command "$@"
ended=0
boot || ended=$?
if [[ ! -s $run/share/status ]]; then
  tail --lines 40 "$run/console" >&2 || true
  ((ended == 124)) && fail "hung: switched off after $limit_s s; its console stands above"
  fail "died (QEMU's exit status $ended); its console stands above"
fi
status=$(<"$run/share/status")
echo "guest: exit status $status, $SECONDS s in all"
exit "$status"
