#!/usr/bin/env bash
# Commits that are new have a subject of at most 72 characters, an empty line, and a body that says why. New is what HEAD
# has beyond origin/main; merges are left out. Older commits are not looked at, so a shallow clone will do.
set -euo pipefail
export LC_ALL=C.UTF-8
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
if ! command -v git >/dev/null; then
    echo "SKIPPED: git is not installed"
    exit 77
fi

# Names what is wrong with the messages of the commits beyond a base. Returns 1 where anything is.
check() { # REPOSITORY BASE
    local status=0 commits commit message subject
    commits=$(git -C "$1" rev-list --no-merges "$2..HEAD") || return 1
    for commit in $commits; do
        message=$(git -C "$1" log -1 --format=%B "$commit")
        subject=${message%%$'\n'*}
        if ((${#subject} > 72)); then
            echo "${commit:0:12}: the subject has ${#subject} characters, more than 72: $subject" >&2
            status=1
        fi
        if [[ $message != "$subject"$'\n\n'* ]]; then
            echo "${commit:0:12}: no body, after an empty line, says why: $subject" >&2
            status=1
        fi
    done
    return "$status"
}

# The check finds what it should, in a repository made for it.
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
commit() { # MESSAGE [BODY]
    local arguments=(-m "$1")
    (($# < 2)) || arguments+=(-m "$2")
    git -C "$folder" -c user.name=test -c user.email=test@localhost -c commit.gpgsign=false \
        commit -q --no-verify --allow-empty "${arguments[@]}"
}
expect() { # STATUS BASE
    local status=0
    check "$folder" "$2" 2>"$folder/said" || status=1
    if [[ $status != "$1" ]]; then
        echo "the check of $2..HEAD ended with $status, not $1: $(<"$folder/said")" >&2
        exit 1
    fi
}
long=$(printf '%72s' "" | tr ' ' x)
git init -q "$folder"
commit "root: as it should be" "It says why."
commit "old: without a body"
commit "$long" "It says why."
expect 0 HEAD
expect 0 HEAD~1
expect 1 HEAD~2
commit "x$long" "It says why."
expect 0 HEAD
expect 1 HEAD~1
commit "new: right again" "It says why."
expect 0 HEAD~1
expect 1 HEAD~2
git -C "$folder" tag side
git -C "$folder" checkout -q --detach HEAD~1
commit "side: another one" "It says why."
git -C "$folder" -c user.name=test -c user.email=test@localhost -c commit.gpgsign=false merge -q --no-edit side
expect 0 HEAD~1

if ! git rev-parse --verify --quiet origin/main >/dev/null; then
    echo "SKIPPED: there is no origin/main, beyond which commits would be new"
    exit 77
fi
check . origin/main
