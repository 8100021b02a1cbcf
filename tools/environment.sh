#!/bin/sh
# Makes FOLDER a Python environment with bpy and the build's tools; does nothing when it already is one.
#
#   environment.sh FOLDER     OPAL_PYTHON chooses the Python (see find-python.sh)
set -eu
folder=$1
requirements=$(dirname "$0")/requirements.txt
wanted=$(cksum <"$requirements")

# Ready, and of the Python that was asked for, if one was.
if [ -f "$folder/.ready" ] && [ "$(cat "$folder/.ready")" = "$wanted" ]; then
  [ -z "${OPAL_PYTHON:-}" ] && exit 0
  tag='import sys; print(sys.version_info[:2])'
  [ "$("$folder/bin/python" -c "$tag")" = "$("$OPAL_PYTHON" -c "$tag")" ] && exit 0
fi

python=$("$(dirname "$0")/find-python.sh")
case $("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])') in
  3.13) bpy=5.2.3 ;;
  3.11) bpy=4.5.15 ;;
esac
compiler=${CXX:-c++}
command -v "$compiler" >/dev/null || compiler=g++
echo '#include <concepts>
int main() {}' | "$compiler" -std=c++20 -fsyntax-only -x c++ - 2>/dev/null ||
  { echo "Opal needs a C++20 compiler (GCC 11, Clang 14 or newer); '$compiler' is not one: install g++ or set CXX." >&2; exit 1; }

echo "Making $folder: $python with bpy $bpy (350 MB the first time)"
rm -rf "$folder"
"$python" -m venv "$folder"
"$folder/bin/python" -m pip install --quiet --disable-pip-version-check -r "$requirements" "bpy==$bpy"
command -v cmake >/dev/null || "$folder/bin/python" -m pip install --quiet --disable-pip-version-check 'cmake>=3.20'
command -v ninja >/dev/null || "$folder/bin/python" -m pip install --quiet --disable-pip-version-check 'ninja>=1.10'
echo "$wanted" >"$folder/.ready"
