# bash completion for relief and relief-sim: verbs, options and values are read from --help of the installed programs. For
# zsh: autoload -U bashcompinit && bashcompinit && source this file.
_relief() {
    local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]} verb='' verbs word help value
    # bash splits --option=value into three words.
    if [ "$cur" = = ]; then
        cur=
    elif [ "$prev" = = ] && [ "$COMP_CWORD" -ge 2 ]; then
        prev=${COMP_WORDS[COMP_CWORD - 2]}
    fi
    COMPREPLY=()
    help=$("${COMP_WORDS[0]}" --help 2>/dev/null) || return
    verbs=$(sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p' <<<"$help" | tr '\n' ' ')
    for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
        if [[ " $verbs" == *" $word "* ]]; then
            verb=$word
            help=$("${COMP_WORDS[0]}" "$verb" --help 2>/dev/null)
            break
        fi
    done
    # The line of an option is "  -o,--output OUT.relief  Description"; flags have no value.
    value=$(sed -nE 's/^  (-[^ ]*) ([^ ].*)/\1 \2/p' <<<"$help" | awk -v option="$prev" '
        index("," $1 ",", "," option ",") && $2 != "Excludes:" && $2 != "REQUIRED" { print $2 }')
    local choice='^(\[.*\])?([a-z0-9-]+(\|[a-z0-9-]+)+)$'
    if [[ $value =~ $choice ]]; then
        mapfile -t COMPREPLY < <(compgen -W "${BASH_REMATCH[2]//|/ }" -- "$cur")
    elif [[ $value == DIR || $value == FOLDER ]]; then
        compopt -o filenames 2>/dev/null
        mapfile -t COMPREPLY < <(compgen -d -- "$cur")
    elif [[ -n $value && ! $value =~ (\.|^FILE$|^MESH$|^OUT$) ]]; then
        return
    elif [[ -z $value && $cur == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(sed -nE 's/^  (-[^ ]*).*/\1/p' <<<"$help" | tr ',\n' '  ')" -- "$cur")
    elif [[ -z $value && -n $verbs && -z $verb ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$verbs" -- "$cur")
    else
        compopt -o filenames 2>/dev/null
        mapfile -t COMPREPLY < <(compgen -f -- "$cur")
    fi
}
complete -F _relief relief relief-sim
