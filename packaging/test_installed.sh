#!/usr/bin/env bash
# test_installed.sh FOLDER, as root in a clean Debian with apt: installs the .deb files of the folder, uses each, removes them
# and looks for what is left.
set -euo pipefail
debs=$1
export DEBIAN_FRONTEND=noninteractive
cd "$(mktemp -d)"
fail() {
  echo "FAILED: $*" >&2
  exit 1
}
install() { apt-get -q -y -o Dpkg::Use-Pty=0 --no-install-recommends install "$@" >apt.log || { cat apt.log; fail "install $*"; }; }
files_of_ours() { find / -xdev -path /proc -prune -o -iname '*helixnav*' -print | grep -vE "^($debs|$PWD|/var/lib/dpkg|/var/log)" || true; }

apt-get -q update >/dev/null

echo "== program"
install "$debs"/helixnav_*.deb
helixnav --version
helixnav simulate large-loop --seed 1 --out loop --quiet | tail -3
test -s loop/report.html
helixnav new-vehicle robot >/dev/null
helixnav replay robot --out own --quiet | tail -1
helixnav new-vehicle like --like plaza >/dev/null
cmp like/vehicle.toml /usr/share/helixnav/vehicles/plaza.toml
for command in $(helixnav --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z-]*\) .*/\1/p'); do
  dpkg -L helixnav | grep -q "/man1/helixnav-$command\.1\.gz$" || fail "no manual page of $command"
done
test -x /usr/share/doc/helixnav/examples/campaign/slurm_array.sh || fail "the examples cannot be run"
completed=$(bash -c '. /usr/share/bash-completion/completions/helixnav
  COMP_WORDS=(helixnav repl) COMP_CWORD=1; _helixnav; echo "${COMPREPLY[*]}"')
[[ $completed == replay ]] || fail "completed repl to '$completed'"
completed=$(bash -c '. /usr/share/bash-completion/completions/helixnav
  COMP_WORDS=(helixnav replay --association jc) COMP_CWORD=3; _helixnav; echo "${COMPREPLY[*]}"')
[[ $completed == jcbb ]] || fail "completed --association jc to '$completed'"

echo "== Python module"
install "$debs"/python3-helixnav_*.deb
python3 - <<'PYTHON'
import helixnav
run = helixnav.replay(helixnav.read_log("robot"), out="python")
print(helixnav.__version__, len(run), "scans", len(run.map), "landmarks")
PYTHON
for table in trajectory.tum map.csv decisions.csv; do cmp "own/$table" "python/$table"; done
python3 /usr/share/doc/helixnav/examples/python/tutorial.py picture.svg | tail -1

python3 - <<'PYTHON'
import os, re, sys
dead = [(page, link) for folder, _, names in os.walk("/usr/share/doc/helixnav") for page in
        (os.path.join(folder, name) for name in names if name.endswith(".md"))
        for link in re.findall(r"\]\(([^)\s#]+)", open(page, encoding="utf-8").read())
        if not re.match("[a-z]+:", link) and not os.path.exists(os.path.join(folder, link))]
sys.exit(f"FAILED: dead links: {dead}" if dead else 0)
PYTHON
python3 -c 'import importlib.metadata; print("dist-info:", importlib.metadata.version("helixnav"))'

echo "== library"
install "$debs"/libhelixnav-dev_*.deb g++ cmake make
cp -r /usr/share/doc/libhelixnav-dev/examples/consumer .
cmake -S consumer -B by-cmake -DCMAKE_BUILD_TYPE=Release >cmake.log && cmake --build by-cmake >>cmake.log || { cat cmake.log; fail "CMake"; }
by-cmake/consumer
g++ -std=c++17 consumer/consumer.cpp -o by-pkg-config $(pkg-config --cflags --libs helixnav)
[[ $(./by-pkg-config) == "$(by-cmake/consumer)" ]] || fail "pkg-config makes another program"
g++ -std=c++17 -O2 -march=native consumer/consumer.cpp -o native $(pkg-config --cflags --libs helixnav)
landmarks=$(by-cmake/consumer | grep -o '^[0-9]* landmarks')
[[ $(./native) == "$landmarks, robot at "* ]] || fail "compiled with -march=native it says: $(./native 2>&1)"

echo "== licences"
for binary in /usr/bin/helixnav /usr/lib/python3/dist-packages/helixnav/_helixnav*.so; do
  for library in $(objdump -p "$binary" | sed -n 's/^ *NEEDED *\(.*\)\.so.*/\1/p' | grep -v '^ld-'); do
    grep -qwF -- "$library" /usr/share/doc/helixnav/copyright || fail "copyright does not name $library, which $binary links"
  done
done

echo "== removal"
apt-get -q -y purge helixnav libhelixnav-dev python3-helixnav >apt.log || { cat apt.log; fail "purge"; }
left=$(files_of_ours)
[[ -z $left ]] || fail "left behind: $left"
echo "installed, used and removed"
