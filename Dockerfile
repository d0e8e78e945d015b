# syntax=docker/dockerfile:1
# Two stages: the first installs the locked requirements and compiles every kernel, the second only runs.
#   docker build -t polhode .
#   docker run --read-only --tmpfs /tmp --shm-size 256m --cap-drop ALL -p 8000:8000 polhode

FROM python:3.11-slim-bookworm AS build

ENV PYTHONDONTWRITEBYTECODE=1 PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_NO_CACHE_DIR=1
WORKDIR /polhode
RUN python -m venv /polhode/environment
COPY requirements.lock .
RUN environment/bin/pip install --require-hashes -r requirements.lock
COPY core core
COPY service service
COPY examples examples
COPY docker docker
# Kernels are compiled by answering every example once, and kept beside the compiler's setting below. The generic
# processor is named so that the image runs on every machine of its architecture.
ENV NUMBA_CACHE_DIR=/polhode/compiled NUMBA_CPU_NAME=generic
RUN mkdir compiled && environment/bin/python -m service.execution.compilation && environment/bin/python -m compileall -q core service

FROM python:3.11-slim-bookworm

# A volume that is mounted at a folder of the image is given that folder's owner.
RUN useradd --uid 10001 --no-create-home --shell /usr/sbin/nologin polhode && mkdir /data && chown 10001 /data
COPY --from=build /polhode /polhode
WORKDIR /polhode
# Schedulers and workers of a cluster are programs of the environment, which import the service.
ENV PATH=/polhode/environment/bin:$PATH \
    PYTHONPATH=/polhode \
    PYTHONDONTWRITEBYTECODE=1 \
    PYTHONUNBUFFERED=1 \
    COMPILED=/polhode/compiled \
    NUMBA_CACHE_DIR=/tmp/compiled \
    NUMBA_CPU_NAME=generic \
    POLHODE_HOST=0.0.0.0 \
    POLHODE_DATA=/data
USER 10001
EXPOSE 8000
STOPSIGNAL SIGTERM
HEALTHCHECK --interval=10s --timeout=2s --start-period=60s --retries=3 \
    CMD ["python", "-c", "import urllib.request; urllib.request.urlopen('http://127.0.0.1:8000/readyz', timeout=1)"]
ENTRYPOINT ["sh", "/polhode/docker/entry.sh"]
