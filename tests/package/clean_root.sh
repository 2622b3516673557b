#!/bin/bash
# Makes the Debian packages of a build, has lintian look at them, installs them in a new root that holds nothing but
# Debian's minimum, and runs the demo and the manual page there. Needs root, or unprivileged user namespaces.
#
#   clean_root.sh BUILD
set -euo pipefail
build=$(realpath "$1")
scratch=$(mktemp --directory)
trap 'rm -rf "$scratch"' EXIT
chmod 755 "$scratch"

export DEBFULLNAME="Tenon's tests" DEBEMAIL=tests@debian.org
cpack --config "$build/CPackConfig.cmake" -B "$scratch/packages" >"$scratch/cpack.log" || {
  cat "$scratch/cpack.log" >&2
  exit 1
}
rm -rf "$scratch/packages/_CPack_Packages"
ls -l "$scratch/packages" | awk 'NR > 1 {print $5, $9}'

if ! lintian --allow-root --fail-on error "$scratch"/packages/*.deb; then
  echo "FAILED: lintian has found errors" >&2
  exit 1
fi
echo "lintian: no errors"

# Runs with the new root as its argument.
cat >"$scratch/try.sh" <<'END'
#!/bin/bash
set -euo pipefail
root=$1
run() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive "$@"; }
install() { run sh -c "apt-get install --quiet --quiet --no-install-recommends $1 >/dev/null"; }
install "--yes /packages/tenon_*.deb"
install "--simulate /packages/libtenon-dev_*.deb"
if run sh -c 'command -v c++ cmake python3'; then
  echo "FAILED: the root is not clean" >&2
  exit 1
fi
run tenon-plan --version
# At 100 Hz: a machine that tests something else beside this is no trouble.
run /usr/share/tenon/demo.sh --bin /usr/bin --task box_on_table_2d --cell lwa4p --output /tmp/demo
run sh -c 'ls /tmp/demo'
# As it is without options, at 500 Hz: once more where the machine gave it no time.
for attempt in 1 2 3; do
  if run /usr/share/tenon/demo.sh --bin /usr/bin --output /tmp/default; then break; fi
  ((attempt < 3))
done
# For the logs of other tools.
run tenon-monitor export /tmp/demo/run.lcmlog --csv /tmp/demo/run.csv --mcap /tmp/demo/run.mcap
install "--yes /packages/python3-tenon_*.deb"
sed -n '/^```python$/,/^```$/{/^```/d;p}' "$root/usr/share/tenon/shared/python/README.md" >"$root/tmp/demo/example.py"
run sh -c 'cd /tmp/demo && python3 example.py'
END
chmod +x "$scratch/try.sh"
mmdebstrap --quiet --variant=minbase \
  --customize-hook="copy-in $scratch/packages /" \
  --customize-hook="$scratch/try.sh \"\$1\"" \
  bookworm "$scratch/root.tar"
echo "packages: installed in a clean root, where the demo has run"
