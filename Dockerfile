# syntax=docker/dockerfile:1
# uictest in an image: docker build -t uictest . && docker run --rm -v "$PWD:/work" uictest run scenarios
ARG PYTHON=3.12

FROM python:${PYTHON}-slim AS build
WORKDIR /source
COPY . .
RUN python -m pip wheel --no-cache-dir --no-deps --wheel-dir /wheels .

FROM python:${PYTHON}-slim
RUN --mount=type=bind,from=build,source=/wheels,target=/wheels \
    python -m pip install --no-cache-dir /wheels/*.whl \
    && useradd --create-home --uid 1000 uictest \
    && install --directory --owner uictest --group uictest /work
USER 1000
WORKDIR /work
ENTRYPOINT ["uictest"]
CMD ["--help"]
