# SPDX-License-Identifier: BSD-3-Clause
# A small image for continuous integration, without root:
#   docker build -t gym-sitl .
#   docker run --rm -v "$PWD:/work" gym-sitl exec -- python my_script.py
# Compiled code is for one processor: keep /cache between runs, for instance as a volume.
ARG PYTHON=3.12
FROM python:${PYTHON}-slim AS build
WORKDIR /source
COPY pyproject.toml README.md LICENSE ./
COPY sitl ./sitl
RUN pip wheel --no-cache-dir --no-deps -w /wheels .

FROM python:${PYTHON}-slim
ARG EXTRAS=demo
RUN --mount=type=bind,from=build,source=/wheels,target=/wheels \
    pip install --no-cache-dir "$(ls /wheels/*.whl)[$EXTRAS]" pytest \
    && useradd --create-home --uid 1000 pilot \
    && install -d -o pilot -g pilot /cache /work
USER pilot
ENV SITL_CACHE_DIR=/cache
WORKDIR /work
VOLUME /cache
ENTRYPOINT ["sitl"]
CMD ["doctor"]
