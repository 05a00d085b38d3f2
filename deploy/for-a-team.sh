#!/bin/sh
# Brings the containers up for everybody on the network, and shows the link that makes the first admin, as a QR code too:
#   deploy/for-a-team.sh                    with a simulated vehicle, at this machine's address on its network
#   deploy/for-a-team.sh 192.168.1.10       at another of its addresses
# A file .env that is there stays as it is; it says what the settings are.
set -eu
cd "$(dirname "$0")/.."

own_address() {
    found=$(ip -4 route get 192.0.2.1 2>/dev/null | sed -n 's/.* src \([0-9.]*\).*/\1/p')
    [ -n "$found" ] || found=$(hostname -I 2>/dev/null | cut -d ' ' -f 1)
    [ -n "$found" ] || found=$(ipconfig getifaddr en0 2>/dev/null || true)
    printf '%s' "$found"
}

if [ -e .env ]; then
    [ $# -eq 0 ] || { echo "The address stands in .env already: change ADDRESS there." >&2; exit 2; }
else
    address=${1:-$(own_address)}
    [ -n "$address" ] || { echo "No network found. This machine's address on yours: $0 192.168.1.10" >&2; exit 2; }
    case $address in
        -* | *[!A-Za-z0-9.-]*) echo "Only an address or a name, like this: $0 192.168.1.10" >&2; exit 2 ;;
    esac
    printf 'ADDRESS=%s\nLISTEN=0.0.0.0\nCOMPOSE_PROFILES=simulated\n' "$address" > .env
fi

docker compose up --detach
echo 'Waiting for the server: a minute or two at the first start.'
began=$(docker inspect --format '{{.State.StartedAt}}' "$(docker compose ps --all --quiet server)")
tries=300
until said=$(docker compose logs --no-log-prefix --since "$began" server | grep -E '#/first-admin/|signs in\.'); do
    tries=$((tries - 1))
    [ "$tries" -gt 0 ] || { echo 'It does not answer; docker compose logs server says why.' >&2; exit 1; }
    sleep 2
done

link=$(printf '%s\n' "$said" | sed -n 's|.*\(https*://[^ ]*#/first-admin/[^ ]*\).*|\1|p' | tail -n 1)
mode=$(docker compose exec -T server python -c \
    'import json, urllib.request as u; print(json.load(u.urlopen("http://127.0.0.1:8600/api/session", timeout=4))["mode"])' \
    2>/dev/null || true)
if [ -n "$link" ] && [ "$mode" != people ]; then # the log still names a link that was used since
    echo 'Scan this with a phone on your network, or open the link. It makes the first admin, once:'
    docker compose exec -T server python -c \
        'import sys, segno; segno.make(sys.argv[1], error="l", micro=False).terminal(border=2, compact=True)' "$link"
    echo "$link"
else
    page=$(docker compose exec -T server printenv CROSSFIX_PUBLIC_URL | sed 's|:443$||')
    echo "It is up at $page: whoever uses it signs in."
fi
