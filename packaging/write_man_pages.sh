#!/usr/bin/env bash
# write_man_pages.sh PROGRAM FOLDER: a page for the program and one for each of its commands, from their --help.
set -euo pipefail
program=$1 folder=$2
rm -rf "$folder"
mkdir -p "$folder"
also=$folder/also.h2m

# page <name> <what it does> <words to run>
page() {
  help2man --no-info --source HelixNav --name "$2" --include "$also" "$3" |
    sed -e "s/^\.TH HELIXNAV /.TH ${1^^} /" -e '/^\.TH/a .ad l' -e "s/^helixnav \\\\- /$1 \\\\- /" |
    awk '/^\.(SH|SS|PP)/ { if (unfilled) print ".fi"; unfilled = 0; example = /EXAMPLE|Example/ }
         { print }
         example && /^\.IP/ && !unfilled { print ".nf"; unfilled = 1 }
         END { if (unfilled) print ".fi" }' | gzip -9n >"$folder/$1.1.gz"
}

commands=$("$program" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z-]*\)  *\(.*\)/\1|\2/p')
{
  echo "[SEE ALSO]"
  sed 's/|.*//; s/.*/.BR helixnav-& (1),/' <<<"$commands"
  echo "and the pages in /usr/share/doc/helixnav"
} >"$also"
page helixnav "landmark navigation with an exact compressed EKF" "$program"
printf '[SEE ALSO]\n.BR helixnav (1)\n' >"$also"
while IFS='|' read -r name does; do page "helixnav-$name" "${does,}" "$program $name"; done <<<"$commands"
rm "$also"
