#!/usr/bin/env bash
# One check of the page in the folder OUT that build.sh made: build, types, unit, e2e, bench, soak,
# wasm (the page without a server in the folder KERF_SITE, which ./dev wasm makes). Exit status 77: a program that
# the check needs is not installed. Further arguments go to vitest.
#     web/test.sh CHECK OUT [VITEST OPTION...]
set -euo pipefail
[ $# -ge 2 ] || { echo "usage: web/test.sh CHECK OUT" >&2; exit 2; }
check=$1 out=$2
shift 2
command -v node >/dev/null && command -v npm >/dev/null || { echo "Node.js or npm is not installed"; exit 77; }
[ "$check" != build ] || exec "$(dirname "$0")/build.sh" "$out"
cd "$out"
case $check in
  types) exec node node_modules/typescript/bin/tsc --noEmit ;;
  unit) exec node node_modules/vitest/vitest.mjs run --dir tests/unit "$@" ;;
  e2e | bench | soak | wasm)
    [ "$check" != wasm ] || [ -f "${KERF_SITE:-}/kerf.wasm" ] || { echo "the page in WebAssembly is not built: ./dev wasm"; exit 77; }
    [ -x "${KERF_CHROMIUM:-/usr/bin/chromium}" ] || { echo "chromium is not installed"; exit 77; }
    exec node node_modules/vitest/vitest.mjs run --dir "tests/$check" "$@" ;;
  *) echo "web/test.sh: unknown check $check" >&2; exit 2 ;;
esac
