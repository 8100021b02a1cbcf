#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Renders frames on a farm: every frame's passes in parts, each part one plain `blender -b` command, then merged exactly.
#
#   examples/batch.sh FILE.blend FIRST LAST [PARTS] [FOLDER]
#
# FIRST LAST   frames
# PARTS        how many commands share the passes of a frame (default 2)
# FOLDER       where films and pictures go (default: FILE's name without .blend)
#
# BLENDER      the program (default blender); Opal has to be installed and enabled in it
# RUN          put before each command, to send it elsewhere: RUN="srun -N1", RUN="ssh node7" (default: here)
# JOBS         how many commands run at once (default 1)
# OVERWRITE    1 renders again what is there already; otherwise it is kept, so an interrupted batch goes on where it was
#
# Exit: 0 when every frame is whole, else the number of frames that are not (99 at most). Every command logs into FOLDER/logs.
set -u
if [ $# -lt 3 ]; then
  sed -n '3,17s/^# \{0,1\}//p' "$0" >&2
  exit 2
fi
file=$(realpath "$1") first=$2 last=$3 parts=${4:-2} folder=${5:-${1%.blend}}
blender=${BLENDER:-blender} run=${RUN:-} jobs=${JOBS:-1}
[ -f "$file" ] || { echo "There is no file $file." >&2; exit 2; }
mkdir -p "$folder/logs" "$folder/films" && folder=$(realpath "$folder") || exit 2

# What each command sets before it renders: its share of the passes. The last part takes the rest.
share='
import bpy, os, sys
part, parts, film = int(sys.argv[-3]), int(sys.argv[-2]), sys.argv[-1]
for scene in bpy.data.scenes:
    opal = scene.opal
    first, last = (opal.passes * k // parts for k in (part, part + 1))
    if first == last and scene == bpy.context.scene:
        open(film + "_none", "w").close()  # more parts than passes: nothing is left for this one
        os._exit(0)
    opal.pass_first, opal.passes = opal.pass_first + first, max(1, last - first)
    opal.use_film_file, opal.film_path = True, film + ".npz"
'
merge='
import bpy, sys
frame, parts, folder = int(sys.argv[-3]), int(sys.argv[-2]), sys.argv[-1]
pattern = f"frame_{frame:04d}_part_*_of_{parts}_*.npz"
bpy.ops.opal.merge(directory=f"{folder}/films", pattern=pattern, output=f"{folder}/frame_{frame:04d}.exr")
'

say() { printf '%(%H:%M:%S)T %s\n' -1 "$*"; }

picture_of() { printf '%s/frame_%04d.exr' "$folder" "$1"; }
name_of() { printf 'frame_%04d_part_%d_of_%d' "$1" "$2" "$parts"; }  # frame, part

why() {  # log: its last error, else the last thing it says
  local said
  said=$(grep -i error "$1" | tail -n 1)
  [ -n "$said" ] || said=$(grep . "$1" | tail -n 1)
  printf '%s' "${said:-nothing is in $1}"
}

part_of() {  # frame, part
  local name log
  name=$(name_of "$1" "$2") log=$folder/logs/$(name_of "$1" "$2").log
  [ ! -e "$folder/logs/$name.done" ] || { say "$name is there"; return 0; }
  rm -f "$folder/films/${name}_"*  # of a command that was interrupted
  say "$name begins"
  if ! $run "$blender" -b "$file" -E OPAL --python-exit-code 1 --python-expr "$share" \
    -o "$folder/films/${name}_picture_" -F OPEN_EXR -f "$1" -- "$2" "$parts" "$folder/films/$name" >"$log" 2>&1; then
    say "$name failed: $(why "$log")"
  elif ! compgen -G "$folder/films/${name}_*.npz" >/dev/null && [ ! -e "$folder/films/${name}_none" ]; then
    say "$name failed, for it wrote no film: $(why "$log")"
  else
    touch "$folder/logs/$name.done"
    say "$name is done"
  fi
}

for ((frame = first; frame <= last; frame++)); do
  if [ "${OVERWRITE:-0}" = 1 ]; then  # whatever number of parts it was made of
    stem=$(printf 'frame_%04d' "$frame")
    rm -f "$(picture_of "$frame")" "$folder/films/${stem}_part_"* "$folder/logs/${stem}_part_"*.done
  elif [ -e "$(picture_of "$frame")" ]; then
    continue
  fi
  for ((part = 0; part < parts; part++)); do
    while [ "$(jobs -rp | wc -l)" -ge "$jobs" ]; do wait -n; done
    part_of "$frame" "$part" &
  done
done
wait

missing=0
for ((frame = first; frame <= last; frame++)); do
  picture=$(picture_of "$frame")
  if [ ! -e "$picture" ]; then
    whole=1
    for ((part = 0; part < parts; part++)); do
      [ -e "$folder/logs/$(name_of "$frame" "$part").done" ] || whole=0
    done
    log=$(printf '%s/logs/frame_%04d_merge.log' "$folder" "$frame")
    if [ $whole = 1 ] && ! $run "$blender" -b "$file" --python-exit-code 1 --python-expr "$merge" -- "$frame" "$parts" "$folder" \
      >"$log" 2>&1; then
      say "the films of frame $frame were not merged: $(why "$log")"
    fi
  fi
  if [ -e "$picture" ]; then
    say "frame $frame is whole: $picture"
  else
    say "frame $frame is missing"
    missing=$((missing + 1))
  fi
done
exit $((missing < 99 ? missing : 99))
