# plotly.js, basic bundle (MIT): this very version, known by its hash, once into the folder $1.
set -eu
version=3.7.0 hash=c23b03591a6bdad0bd0f47a0c5c52305a5519812b73ce254be65cd841553c9c2
file="$1/plotly-basic-$version.min.js"
right() { echo "$hash  $1" | sha256sum --check --status 2>/dev/null; }
if ! right "$file"; then
  command -v npm >/dev/null || {
    echo "the page's plots need plotly.js: install npm (Debian: npm), or put plotly-basic.min.js of" \
         "plotly.js-basic-dist-min $version at $file" >&2
    exit 1
  }
  mkdir -p "$1"
  fresh=$(mktemp -d "$1/fresh.XXXXXX")
  trap 'rm -rf "$fresh"' EXIT
  (cd "$fresh" && npm pack --silent "plotly.js-basic-dist-min@$version" >/dev/null &&
    tar -xzf plotly.js-basic-dist-min-$version.tgz package/plotly-basic.min.js) ||
    { echo "npm could not get plotly.js-basic-dist-min $version: is there a network?" >&2; exit 1; }
  right "$fresh/package/plotly-basic.min.js" ||
    { echo "npm gave another plotly.js-basic-dist-min $version than the one that is known" >&2; exit 1; }
  mv "$fresh/package/plotly-basic.min.js" "$file"
fi
echo "$file"
