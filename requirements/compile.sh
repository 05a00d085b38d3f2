#!/bin/sh
# The packages of constraints.txt with the hashes of all their files, for every platform; no address stands in the result.
#   ./compile.sh PATH-OF-UV        (or: make requirements)
set -eu
cd "$(dirname "$0")"
uv=$1
pinned() {
    out=$1; shift
    printf 'setuptools>=77\n' | "$uv" pip compile - ../pyproject.toml "$@" -c ../constraints.txt --generate-hashes --universal \
        --python-version 3.11 --no-emit-index-url --no-header --no-annotate --quiet -o "$out"
}
pinned server.txt --extra server
pinned run.txt --extra server --extra study
pinned development.txt --extra server --extra study --extra dev
printf 'cyclonedx-bom\npip-audit\n' | "$uv" pip compile - --generate-hashes --universal --python-version 3.11 --no-emit-index-url \
    --no-header --no-annotate --quiet -o audit.txt
