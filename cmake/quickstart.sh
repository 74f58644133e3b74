#!/bin/sh
# All that a new user needs on a bare Debian 12:
#   sh cmake/quickstart.sh demo    a real solid, from its surface to a calibrated mass-spring model in out/elephant/
#   sh cmake/quickstart.sh test    build everything and run the tests
#   sh cmake/quickstart.sh study   the accuracy study of methods, meshes and materials, into docs/results/ (half an hour)
#   sh cmake/quickstart.sh performance   speed beside other programs, into docs/performance.md
# Each installs the Debian packages that it is missing; run again, it does only what is left to do.
#   sh cmake/quickstart.sh packages demo   names the packages of a command, and does nothing
set -eu
cd "$(dirname "$0")/.."

# What each command's preset looks for, and what the command runs; tests/quickstart compares.
core_packages="g++ cmake ninja-build libeigen3-dev"
factor_packages="libsuitesparse-dev libopenblas0-serial"
program_packages="$core_packages $factor_packages pkg-config libtbb-dev libcgal-dev nlohmann-json3-dev libhdf5-dev
                  libcli11-dev"
study_packages="$core_packages $factor_packages pkg-config libtbb-dev libcgal-dev coinor-libipopt-dev libpagmo-dev"
test_packages="$program_packages coinor-libipopt-dev libpagmo-dev doctest-dev python3 python3-h5py python3-scipy
               clang"
performance_packages="$core_packages $factor_packages pkg-config libtbb-dev coinor-libipopt-dev libbenchmark-dev
                      libbullet-dev libmujoco-dev libpetsc-real-dev libopenmpi-dev python3 python3-scipy"

packages_of() {
    case "$1" in
    demo) echo $program_packages ;;
    test) echo $test_packages ;;
    study) echo $study_packages ;;
    performance) echo $performance_packages ;;
    *) usage ;;
    esac
}

usage() {
    echo "usage: sh cmake/quickstart.sh demo|test|study|performance" >&2
    echo "       sh cmake/quickstart.sh packages demo|test|study|performance" >&2
    exit 2
}

# need_root <what> <commands>: ends where what needs root cannot be done, with the commands that do it.
need_root() {
    if [ "$(id -u)" -ne 0 ] && ! command -v sudo >/dev/null; then
        echo "quickstart: $1 needs root, and there is no sudo; as root, run: $2" >&2
        exit 2
    fi
}

as_root() {
    if [ "$(id -u)" -eq 0 ]; then
        "$@"
    else
        sudo "$@"
    fi
}

install_missing() {
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        echo "quickstart: expected Debian 12 or a system like it, found no dpkg and apt-get; elsewhere install what" \
            "docs/install.md names, and build with cmake --preset program" >&2
        exit 2
    fi
    missing=""
    for package in "$@"; do
        dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
    done
    [ -n "$missing" ] || return 0
    need_root "installing packages" "apt-get update && apt-get install -y --no-install-recommends$missing"
    echo "installing:$missing"
    as_root apt-get update -qq
    as_root env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends $missing >/dev/null
}

# The surfaces come with CGAL's own examples; they are taken out of the package without installing it.
fetch_surfaces() {
    missing=""
    for surface in "$@"; do
        [ -s "build/data/$surface.off" ] || missing="$missing $surface"
    done
    [ -n "$missing" ] || return 0
    echo "fetching:$missing"
    mkdir -p build/data
    (
        cd build/data
        rm -rf package libcgal-demo_*.deb
        if ! apt-get download -qq libcgal-demo 2>/dev/null; then # no package lists, or old ones
            need_root "reading the lists of packages" "apt-get update"
            as_root apt-get update -qq
            apt-get download -qq libcgal-demo
        fi
        dpkg-deb -x libcgal-demo_*.deb package
        for surface in $missing; do
            tar -xzOf package/usr/share/doc/libcgal-demo/data.tar.gz "data/meshes/$surface.off" >"$surface.off.part"
            mv "$surface.off.part" "$surface.off"
        done
        rm -rf package libcgal-demo_*.deb
    )
}

case "${1:-}" in
demo)
    install_missing $program_packages
    cmake --preset program
    cmake --build build --target springfit
    fetch_surfaces elephant
    build/bin/springfit fit build/data/elephant.off --young 5e4 --poisson 0.45 --density 1000 \
        --nodes 2000 --out out/elephant
    ;;
test)
    install_missing $test_packages
    cmake --preset default
    cmake --build build
    ctest --test-dir build --output-on-failure -j "$(nproc)"
    ;;
study)
    install_missing $study_packages
    cmake --preset study
    cmake --build build --target springfit_study
    fetch_surfaces elephant fandisk knot1 bear femur homer
    build/bin/springfit_study --data build/data --out docs/results
    ;;
performance)
    install_missing $performance_packages
    cmake --preset bench
    cmake --build build-bench --target springfit_speed
    programs=""
    for program in machine step peers_step peers_step_double fit solve peers_fit; do
        [ ! -x "build-bench/bin/bench_$program" ] || programs="$programs build-bench/bin/bench_$program"
    done
    python3 bench/speed/report.py $programs --out docs
    ;;
packages)
    packages_of "${2:-}"
    ;;
*)
    usage
    ;;
esac
