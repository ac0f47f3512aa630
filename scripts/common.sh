# shellcheck shell=bash
# Shared by the scripts of this folder, which source it: where things are, and how much may run at
# once. It moves into the repository's root, so that every script works from any folder.

unset CDPATH  # else `cd` may go elsewhere, and print where
caller=$PWD
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
cd "$root" || exit

fail() {
  echo "$(basename "$0"): $*" >&2
  exit 1
}

# The build folder of a preset, as CMakePresets.json has it: `ci` differs from `release` in flags and
# has the benchmarks too, `bench` has these in place of the tests.
build_folder() {
  case $1 in
    ci | bench) echo "$root/build/release" ;;
    *) echo "$root/build/$1" ;;
  esac
}

# Options of CMake that suit this machine's processor.
processor_options() {
  local flag avx2=ON
  for flag in avx2 bmi1 bmi2 abm popcnt; do
    grep -qw -m 1 "$flag" /proc/cpuinfo 2>/dev/null || avx2=OFF
  done
  echo "-DMESHGRAIN_AVX2=$avx2"
}

cores() {
  nproc 2>/dev/null || getconf _NPROCESSORS_ONLN
}

# Compile jobs: one a core, but no more than memory holds, as Eigen and oneTBB need up to 1.5 GB a
# file. MESHGRAIN_JOBS overrides it.
jobs_for_memory() {
  local jobs kib limit
  jobs=$(cores)
  if [[ -r /proc/meminfo ]]; then
    kib=$(awk '/^MemAvailable:/ { print $2 }' /proc/meminfo)
    # A container may be allowed less than the machine has ("max" means no limit).
    limit=$(cat /sys/fs/cgroup/memory.max 2>/dev/null || echo max)
    if [[ $limit != max ]] && ((limit / 1024 < kib)); then kib=$((limit / 1024)); fi
    if ((kib / 1500000 < jobs)); then jobs=$((kib / 1500000)); fi
  fi
  echo "${MESHGRAIN_JOBS:-$((jobs > 0 ? jobs : 1))}"
}

# A path of the caller's, made absolute.
from_caller() {
  case $1 in
    /*) echo "$1" ;;
    *) echo "$caller/$1" ;;
  esac
}
