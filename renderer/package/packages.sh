# packages.sh: Debian packages for renderer/quickstart.sh and tests/run.sh, which source it.
# shellcheck shell=bash disable=SC2034

BUILD_PACKAGES=(build-essential cmake ninja-build pkg-config
    libembree-dev libopenimageio-dev libopenexr-dev libopencolorio-dev libassimp-dev libjansson-dev libhwloc-dev
    libmicrohttpd-dev zlib1g-dev python3)

# install_packages NAME...: installs those that are missing. Root is asked for only if there are any.
install_packages() {
    command -v dpkg-query >/dev/null || return 0 # no Debian: what is missing shows in the build
    local package missing=()
    for package; do
        [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null) == installed ]] ||
            missing+=("$package")
    done
    ((${#missing[@]} > 0)) || return 0

    local as_root=()
    if ((EUID != 0)); then
        if ! command -v sudo >/dev/null; then
            echo "These packages are missing; install them as root, and start again:" >&2
            echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
            return 1
        fi
        as_root=(sudo)
    fi
    echo "Installing ${missing[*]}"
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q update
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y install --no-install-recommends "${missing[@]}"
}
