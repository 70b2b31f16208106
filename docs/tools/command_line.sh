#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Print docs/reference/command-line.md from the program's own help.
#
#   docs/tools/command_line.sh build/carrom > docs/reference/command-line.md
set -euo pipefail
program=$1

section() {
    printf '\n## %s\n\n```text\n' "$1"
    shift
    printf '%s\n```\n' "$("$program" "$@" --help)"
}

cat <<'END'
# Command line

`docs/tools/command_line.sh` writes this page from the program's help.
END
section carrom
"$program" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]\{1,\}\) .*/\1/p' |
    while read -r command; do section "carrom $command" "$command"; done
