#!/usr/bin/env bash
# Fills fuzz/corpus/ with files to start from: ./seed.sh [FOLDER WITH TEST ASSETS]
# Small files only: large ones slow fuzzing down and show nothing new.
set -euo pipefail
cd "$(dirname "$0")"
assets=${1:-../../shared/assets}
limit=12k
for target in ply obj stl nff scene_toml image_decode glass; do
    mkdir -p "corpus/$target"
    # Inputs that once failed are the best to start from.
    regressions=../crates/snell-scene/tests/data/fuzz/$target
    if [ -d "$regressions" ]; then cp "$regressions"/* "corpus/$target/"; fi
done
cp ../scenes/*.toml corpus/scene_toml/
[ -d "$assets" ] || { echo "no assets at $assets: nothing more to start from"; exit 0; }
copy() { # target, name of the files
    find "$assets" -type f -iname "$2" -size "-$limit" -print0 | while IFS= read -r -d '' file; do
        cp "$file" "corpus/$1/$(sha1sum < "$file" | cut -c1-16)"
    done
}
copy ply '*.ply'
copy stl '*.stl'
copy nff '*.nff'
find "$assets" -type f -iname '*.yml' -size "-$limit" -print0 | while IFS= read -r -d '' file; do
    # The first byte says that it is a page.
    { printf '1'; cat "$file"; } > "corpus/glass/$(sha1sum < "$file" | cut -c1-16)"
done
printf '0CC a catalogue\nNM A 2 0 0 0\nCD 1 0.01\nLD 0.3 2\nIT 0.5 0.9 10\n' > corpus/glass/agf
copy image_decode '*.png'
copy image_decode '*.jpg'
copy image_decode '*.hdr'
find "$assets" -type f -iname '*.obj' -size "-$limit" -print0 | while IFS= read -r -d '' file; do
    # A mesh, 0xff, and the library beside it.
    { cat "$file"; printf '\xff'; cat "${file%.*}.mtl" 2>/dev/null || true; } > "corpus/obj/$(sha1sum < "$file" | cut -c1-16)"
done
for target in ply obj stl nff scene_toml image_decode glass; do echo "$target: $(find "corpus/$target" -type f | wc -l) files"; done
