# One image for server and simulated vehicle: the page built in one stage, the Python environment in another.
# amd64 and arm64: docker buildx build --platform linux/amd64,linux/arm64 .
FROM --platform=$BUILDPLATFORM node:20-bookworm-slim AS page
WORKDIR /page
COPY frontend/package.json frontend/package-lock.json ./
RUN npm ci --no-audit --no-fund --loglevel=error
COPY frontend/ ./
RUN npm run --silent build
# A bill of materials names a version; the page itself has none. It names what `npm install --omit=dev` would bring: with the option
# of that name, `npm sbom` leaves out what a package of the page needs when the page's own tests name it, too (@types/geojson).
RUN npm pkg set version=0.0.0 && npm pkg delete devDependencies && npm prune --no-audit --no-fund --loglevel=error \
 && npm sbom --sbom-format=cyclonedx > /page.cdx.json

FROM python:3.11-slim-bookworm AS environment
RUN python3 -m venv /opt/crossfix && python3 -m venv /opt/bill
WORKDIR /source
COPY requirements/ requirements/
# every package is compared with the hash that stands beside its version
RUN /opt/crossfix/bin/pip install --quiet --no-cache-dir --disable-pip-version-check --no-deps --require-hashes -r requirements/server.txt \
 && /opt/bill/bin/pip install --quiet --no-cache-dir --disable-pip-version-check --no-deps --require-hashes -r requirements/audit.txt
COPY pyproject.toml setup.py README.md LICENSE ./
COPY planner/ planner/
COPY hardware/ hardware/
COPY backend/ backend/
COPY migrations/ migrations/
COPY --from=page /page/dist frontend/dist
RUN /opt/crossfix/bin/pip install --quiet --no-cache-dir --disable-pip-version-check --no-build-isolation --no-deps . \
 && mkdir /opt/crossfix/bill \
 && /opt/bill/bin/cyclonedx-py environment --output-format JSON --output-file /opt/crossfix/bill/server.cdx.json /opt/crossfix/bin/python
COPY --from=page /page.cdx.json /opt/crossfix/bill/page.cdx.json

FROM python:3.11-slim-bookworm
RUN useradd --uid 8600 --create-home --skel /dev/null --home-dir /var/lib/crossfix crossfix \
 && mkdir /secrets /backups && chown crossfix:crossfix /secrets /backups
COPY --from=environment /opt/crossfix /opt/crossfix
# The root file system may be read-only: what is written lies in the volume (the planner's machine code, compiled at the
# first start for the processor it finds, too) and in /tmp.
ENV PATH=/opt/crossfix/bin:$PATH \
    PYTHONUNBUFFERED=1 \
    PYTHONDONTWRITEBYTECODE=1 \
    CROSSFIX_DATA_DIR=/var/lib/crossfix/data \
    CROSSFIX_LOG_FORMAT=json \
    CROSSFIX_LOG_LEVEL=info \
    NUMBA_CACHE_DIR=/var/lib/crossfix/kernels
USER crossfix
WORKDIR /var/lib/crossfix
VOLUME /var/lib/crossfix
EXPOSE 8600
HEALTHCHECK --interval=10s --timeout=5s --start-period=180s --retries=6 \
    CMD ["python", "-c", "import urllib.request as u; u.urlopen('http://127.0.0.1:8600/health', timeout=4)"]
# All addresses of the container; docker-compose.yml publishes nothing but its proxy.
CMD ["crossfix", "serve", "--host", "0.0.0.0"]
