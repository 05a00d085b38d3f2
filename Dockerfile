# One image for server and simulated vehicle: the page built in one stage, the Python environment in another.
FROM node:20-bookworm-slim AS page
WORKDIR /page
COPY frontend/package.json frontend/package-lock.json ./
RUN npm ci --no-audit --no-fund --loglevel=error
COPY frontend/ ./
RUN npm run --silent build

FROM python:3.11-slim-bookworm AS environment
RUN python3 -m venv /opt/crossfix
WORKDIR /source
COPY pyproject.toml constraints.txt README.md LICENSE ./
COPY planner/ planner/
COPY hardware/ hardware/
COPY backend/ backend/
COPY migrations/ migrations/
RUN /opt/crossfix/bin/pip install --quiet --no-cache-dir --disable-pip-version-check -c constraints.txt '.[server,postgresql]'

FROM python:3.11-slim-bookworm
RUN useradd --uid 8600 --create-home --skel /dev/null --home-dir /var/lib/crossfix crossfix
COPY --from=environment /opt/crossfix /opt/crossfix
COPY --from=page /page/dist /opt/crossfix/page
# The planner's machine code is compiled at the first start, for the processor it finds, and kept with the missions.
ENV PATH=/opt/crossfix/bin:$PATH \
    PYTHONUNBUFFERED=1 \
    CROSSFIX_DATA_DIR=/var/lib/crossfix/data \
    CROSSFIX_PAGE_DIR=/opt/crossfix/page \
    NUMBA_CACHE_DIR=/var/lib/crossfix/kernels
USER crossfix
WORKDIR /var/lib/crossfix
EXPOSE 8600
# All addresses of the container; docker-compose.yml publishes the port on the host's loopback only.
CMD ["crossfix", "serve", "--host", "0.0.0.0"]
