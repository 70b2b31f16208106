#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# The steps of the container image. Dockerfile and carrom.def call them, each in an image of Debian
# 13.
#
#   container.sh build SOURCE    install compilers and libraries, build, install to /opt/carrom
#   container.sh run             install what the program needs at run time
#
# Debian 13 names the libraries of `run` after their versions. Another base image needs other names.
set -eu

install() {
    apt-get -q update
    DEBIAN_FRONTEND=noninteractive apt-get -q -y install --no-install-recommends "$@"
    rm -rf /var/lib/apt/lists/*
}

case ${1:-} in
build)
    # git: so that `carrom --version` can name the commit.
    install cmake ninja-build g++ pkg-config git \
        openmpi-bin libopenmpi-dev libhdf5-openmpi-dev \
        libfmt-dev libtomlplusplus-dev libcli11-dev nlohmann-json3-dev \
        librandom123-dev libhwy-dev libxxhash-dev
    cmake -S "$2" -B /tmp/carrom-build -G Ninja -DCARROM_TESTS=OFF \
        -DCMAKE_INSTALL_PREFIX=/opt/carrom
    cmake --build /tmp/carrom-build
    cmake --install /tmp/carrom-build
    rm -rf /tmp/carrom-build
    ;;
run)
    install openmpi-bin libhdf5-openmpi-310 libfmt10 libtomlplusplus3t64 libhwy1t64 libxxhash0
    ;;
*)
    echo "usage: container.sh build SOURCE | container.sh run" >&2
    exit 2
    ;;
esac
