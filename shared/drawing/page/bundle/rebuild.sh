#!/bin/bash
# Makes the bundle of libraries that every page carries, or compares it with the one that stands here. Needs npm
# and its registry; no build of Tenon does.
#
#   rebuild.sh           makes libraries.min.js, libraries.css and SHA256SUMS anew
#   rebuild.sh --check   exit status 1 where they would differ, or a script or style is not formatted
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
command -v npm >/dev/null || "$here/../../../../.ci/setup.sh" page

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp "$here"/{package.json,package-lock.json,libraries.js} "$scratch"
cd "$scratch"
# The lock file has a hash of each package: another one of the same version is refused. Nobody's scripts run.
npm ci --ignore-scripts --no-audit --no-fund >npm.log 2>&1 || { cat npm.log >&2; exit 1; }
# The compiler itself and not its wrapper, which would have to run a script first.
esbuild=$(echo node_modules/@esbuild/*/bin/esbuild)
"$esbuild" libraries.js --bundle --minify --format=iife --global-name=TenonLibraries --legal-comments=none \
  --log-level=warning --outfile=libraries.min.js
cp node_modules/uplot/dist/uPlot.min.css libraries.css
sha256sum libraries.min.js libraries.css >SHA256SUMS

made=(libraries.min.js libraries.css SHA256SUMS)
if [[ ${1:-} != --check ]]; then
  cp "${made[@]}" "$here"
  exit 0
fi
status=0
for file in "${made[@]}"; do
  cmp "$file" "$here/$file" || status=1
done
node node_modules/prettier/bin/prettier.cjs --print-width 110 --log-level warn --check \
  "$here"/../*.js "$here"/../*.css "$here/libraries.js" || status=1
((status)) || echo "page: the bundle is what its libraries make, the scripts are formatted"
exit "$status"
