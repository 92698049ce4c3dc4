#!/usr/bin/env bash
# aarch64_root.sh FOLDER: Debian's libraries and headers of AArch64 that the project needs, downloaded and unpacked below
# FOLDER. Nothing is installed, and the machine's own packages do not change: apt works on lists in FOLDER.
set -euo pipefail
root=$1
readonly packages=(libstdc++-12-dev libeigen3-dev libgmp-dev libmpfr-dev libmpfi-dev libcgal-dev libtbb-dev libfmt-dev
  libcli11-dev nlohmann-json3-dev libzip-dev libzstd-dev libgtest-dev libsimde-dev libz3-dev)

[ "$(cat "$root/packages" 2>/dev/null)" = "${packages[*]}" ] && exit
mkdir -p "$root"/apt/lists/partial "$root"/apt/cache/archives/partial
apt=(apt-get -qq -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o APT::Install-Recommends=false
  -o Dir::State="$root/apt" -o Dir::State::status=/dev/null -o Dir::Cache="$root/apt/cache" -o Debug::NoLocking=true)
"${apt[@]}" update
"${apt[@]}" --yes --download-only install "${packages[@]}"
for package in "$root"/apt/cache/archives/*.deb; do
  dpkg-deb --extract "$package" "$root"
done
echo "${packages[*]}" >"$root/packages"
