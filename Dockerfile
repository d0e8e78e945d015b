# The service with its kernels compiled. Runs as nobody in particular, with a read-only root:
#   docker build -t polhode . && docker run --read-only --tmpfs /tmp -p 8000:8000 polhode
FROM python:3.11-slim AS built
WORKDIR /opt/polhode
COPY requirements.lock .
RUN python -m venv /opt/env && /opt/env/bin/pip install --no-cache-dir --require-hashes -r requirements.lock
COPY core core
COPY service service
# Warming answers every example once, which compiles every kernel into the cache.
RUN NUMBA_CACHE_DIR=/opt/kernels /opt/env/bin/python -m service.prepared

FROM python:3.11-slim
RUN useradd --system --no-create-home polhode
COPY --from=built /opt /opt
WORKDIR /opt/polhode
# The compiler wants to be able to write where it keeps its code, so it is given a copy.
ENV NUMBA_CACHE_DIR=/tmp/kernels POLHODE_HOST=0.0.0.0 PYTHONDONTWRITEBYTECODE=1
USER polhode
EXPOSE 8000
HEALTHCHECK --interval=10s --timeout=2s --start-period=60s \
    CMD ["/opt/env/bin/python", "-c", "import urllib.request as u; u.urlopen('http://127.0.0.1:8000/readyz')"]
CMD ["sh", "-c", "cp -r /opt/kernels /tmp/kernels && exec /opt/env/bin/python -m service"]
