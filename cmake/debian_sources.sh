#!/bin/sh
# debian_sources.sh FOLDER PACKAGE…: unpacks the sources of Debian's packages below FOLDER.
set -eu
mkdir -p "$1/lists/partial"
cd "$1"
shift
cat >debian.sources <<END
Types: deb-src
URIs: http://deb.debian.org/debian
Suites: $(. /etc/os-release && echo "$VERSION_CODENAME")
Components: main
Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg
END
# A separate list, because the machine's list may name no sources.
as_here="-qq -o Dir::Etc::sourcelist=$PWD/debian.sources -o Dir::Etc::sourceparts=/dev/null -o Dir::State::lists=$PWD/lists"
apt-get $as_here update
apt-get $as_here source --only-source "$@"
