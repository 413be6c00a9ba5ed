#!/usr/bin/env bash
# Builds the page of `kerf view`: copies the sources to the folder OUT, installs the packages of package-lock.json
# there if they changed, and writes OUT/dist/index.html and OUT/dist/worker.js. Does nothing if the sources are unchanged.
#     web/build.sh OUT
set -euo pipefail
[ $# = 1 ] || { echo "usage: web/build.sh OUT" >&2; exit 2; }
from=$(cd "$(dirname "$0")" && pwd)
for program in node npm; do
  command -v "$program" >/dev/null || { echo "web/build.sh: $program is not installed (Debian: apt-get install nodejs npm)" >&2; exit 2; }
done
mkdir -p "$1"
cd "$1"
sum() { (cd "$from" && find . -type f ! -path './node_modules/*' ! -path './dist/*' -print0 | LC_ALL=C sort -z | xargs -0 sha256sum); }
if [ -f dist/index.html ] && sum | cmp -s - sources.sha256; then exit 0; fi
rm -rf src tests dist
cp -R "$from/." .
rm -rf dist  # of an earlier wheel
if ! cmp -s package-lock.json node_modules/installed-lock.json; then
  npm ci --no-audit --no-fund --loglevel=error
  cp package-lock.json node_modules/installed-lock.json
fi
node node_modules/vite/bin/vite.js build --logLevel warn
node node_modules/vite/bin/vite.js build --logLevel warn --config vite.worker.config.ts
sum > sources.sha256
