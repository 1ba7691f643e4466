# jvari for systems other than Debian 12:
#   docker build --tag jvari .
#   docker run --rm --volume "$PWD:/work" jvari compare tanpura_c3_release --out report
# tests/dockerfile.sh checks it where no Docker runs: the first stage does what ./demo does, the second holds the libraries that the program loads.
FROM debian:12 AS build
WORKDIR /jvari
COPY . .
RUN .ci/setup
RUN .ci/build release jvari
RUN cmake --install build/release --prefix /usr/local

FROM debian:12-slim
RUN apt-get update && apt-get install -y --no-install-recommends \
    libfftw3-double3 libfmt9 libgsl27 libhwy1 libsamplerate0 libsndfile1 libsundials-cvode6 libtomlplusplus3 \
    nodejs && rm -rf /var/lib/apt/lists/*
COPY --from=build /usr/local /usr/local
COPY --from=build /jvari/node_modules /usr/local/share/jvari/node_modules
ENV JVARI_NODE_MODULES=/usr/local/share/jvari/node_modules
WORKDIR /work
ENTRYPOINT ["jvari"]
