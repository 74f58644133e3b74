#!/bin/sh
# All that a new user needs on a bare Debian 12:
#   sh cmake/quickstart.sh demo    a real solid, from its surface to a calibrated mass-spring model in out/elephant/
#   sh cmake/quickstart.sh test    build everything and run the tests
#   sh cmake/quickstart.sh study   the accuracy study of methods, meshes and materials, into docs/results/ (half an hour)
#   sh cmake/quickstart.sh performance   speed beside other programs, into docs/performance.md
# All install the Debian packages that are missing; run again, they do only what is left to do.
set -eu
cd "$(dirname "$0")/.."

build_packages="g++ cmake ninja-build pkg-config libeigen3-dev libtbb-dev libcgal-dev coinor-libipopt-dev
                nlohmann-json3-dev libhdf5-dev libcli11-dev libsuitesparse-dev libopenblas0-serial"
bench_packages="libbenchmark-dev libbullet-dev libmujoco-dev libpetsc-real-dev python3-scipy"
test_packages="doctest-dev libpagmo-dev python3 python3-h5py"

install_missing() {
    missing=""
    for package in "$@"; do
        dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
    done
    [ -n "$missing" ] || return 0
    as_root=""
    [ "$(id -u)" -eq 0 ] || as_root="sudo"
    echo "installing:$missing"
    $as_root apt-get update -qq
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null
}

# The surfaces come with CGAL's own examples; they are taken out of the package without installing it.
fetch_surfaces() {
    missing=""
    for surface in "$@"; do
        [ -s "build/data/$surface.off" ] || missing="$missing $surface"
    done
    [ -n "$missing" ] || return 0
    mkdir -p build/data
    (
        cd build/data
        apt-get download -qq libcgal-demo
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
    install_missing $build_packages
    cmake --preset default
    cmake --build build --target springfit
    fetch_surfaces elephant
    build/bin/springfit fit build/data/elephant.off --young 5e4 --poisson 0.45 --density 1000 \
        --material neo-hookean --nodes 2000 --volume --static-cases 36 --fit-seconds 120 --out out/elephant
    ;;
test)
    install_missing $build_packages $test_packages
    cmake --preset default
    cmake --build build
    ctest --test-dir build --output-on-failure -j "$(nproc)"
    ;;
study)
    install_missing $build_packages $test_packages
    cmake --preset default
    cmake --build build --target springfit_study
    fetch_surfaces elephant fandisk knot1 bear
    build/bin/springfit_study --data build/data --out docs/results
    ;;
performance)
    install_missing $build_packages $bench_packages
    cmake --preset bench
    cmake --build build-bench --target springfit_speed
    programs=""
    for program in machine step peers_step peers_step_double fit solve peers_fit; do
        [ ! -x "build-bench/bin/bench_$program" ] || programs="$programs build-bench/bin/bench_$program"
    done
    python3 bench/speed/report.py $programs --out docs
    ;;
*)
    echo "usage: sh cmake/quickstart.sh demo|test|study|performance" >&2
    exit 2
    ;;
esac
