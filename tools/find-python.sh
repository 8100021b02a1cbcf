#!/bin/sh
# Prints the path of a Python that has a bpy: 3.13 (bpy 5.2.3) or, failing that, 3.11 (bpy 4.5.15).
#
#   find-python.sh [VERSION...]   look for these versions only, in this order
#
# OPAL_PYTHON, when set, is taken instead. Else PATH is searched, then pyenv's versions. A Python without `venv` does not count.
set -u
works() { # PROGRAM VERSION: it starts, is that version, and can make environments
  [ "$("$1" -c 'import sys, venv, ensurepip; print("%d.%d" % sys.version_info[:2])' 2>/dev/null)" = "$2" ]
}
[ $# -gt 0 ] || set -- 3.13 3.11
if [ -n "${OPAL_PYTHON:-}" ]; then
  for version; do
    works "$OPAL_PYTHON" "$version" && echo "$OPAL_PYTHON" && exit 0
  done
  echo "OPAL_PYTHON=$OPAL_PYTHON is not a Python $(echo "$@" | sed 's/ / or /g') with venv." >&2
  exit 1
fi
# Of a virtual environment the Python it stands on: the environment itself may be what is about to be made anew.
found() { "$1" -c 'import sys; print(getattr(sys, "_base_executable", None) or sys.executable)' && exit 0; }
for version; do
  IFS=:
  for folder in $PATH; do
    for name in "python$version" python3; do
      [ -x "$folder/$name" ] && works "$folder/$name" "$version" && found "$folder/$name"
    done
  done
  unset IFS
  for program in "${PYENV_ROOT:-$HOME/.pyenv}"/versions/"$version"*/bin/"python$version"; do
    [ -x "$program" ] && works "$program" "$version" && found "$program"
  done
done
echo "Opal needs Python $(echo "$@" | sed 's/ / or /g') with venv (3.13 for bpy 5.2.3, 3.11 for bpy 4.5.15); none is on PATH or under ~/.pyenv/versions: install one or set OPAL_PYTHON." >&2
exit 1
