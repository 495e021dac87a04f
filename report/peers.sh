# Engines that npm brings, these very versions, known by their hashes, once into the folder $1/peers; there the
# program runs that is in DUCTILE_PEERS, with $2. What is not to be had, the program says.
set -eu
folder="$1/peers"
mkdir -p "$folder"
get() { # NAME VERSION HASH
  place="$folder/node_modules/$1"
  [ ! -f "$place/.is-$2" ] || return 0
  fresh=$(mktemp -d "$folder/fresh.XXXXXX")
  if (cd "$fresh" && tarball=$(npm pack --silent "$1@$2") && echo "$3  $tarball" | sha256sum --check --status &&
    tar -xzf "$tarball"); then
    rm -rf "$place"
    mkdir -p "$(dirname "$place")"
    mv "$fresh/package" "$place"
    touch "$place/.is-$2"
  else
    echo "npm could not get $1 $2 as it is known: it is left out" >&2
  fi
  rm -rf "$fresh"
}
command -v npm >/dev/null && command -v node >/dev/null || {
  echo "peers need npm and node (Debian: npm): they are left out" >&2
  exit 1
}
get planck 1.5.0 e67f906f6a1c93e0db686784e78365453d10c86d5621d33956bc53814e66acf5
get phaser-box2d 1.1.0 68265c288275910c83e13fec26b335ba3a44ff9f02b9e9a2221f55158c41add9
get box2d3-wasm 5.2.0 a198523ac112d94916fdd5409e6505cbdd6a7698ff7a978d0e4d01ac93528034
get @mujoco/mujoco 3.14.0 f845a07ab81303cc6579fec07136818bed21d44a31c1911340f61e06f4d11eee
printf '%s' "$DUCTILE_PEERS" >"$folder/peers.mjs"
node "$folder/peers.mjs" $2
