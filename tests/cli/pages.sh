# SPDX-License-Identifier: Apache-2.0
# Manual pages made from --help and --manual: formatters accept them, and they list every option. Help is short and
# grouped. bash completes verbs, options and values.
. "$(dirname "$0")/lib.sh"

python3 "$RELIEF_SOURCE/scripts/install/pages.py" pages "$relief" "$relief_sim"
cp pages/*.1 .
# The build creates the same pages for installation.
diff -r pages "$RELIEF_BIN/../install/pages" || die "the pages of the build differ"
completion=$RELIEF_SOURCE/scripts/install/completion.bash
for tool in relief relief-sim; do
    # The installed programs do not create pages.
    expect 1 "$RELIEF_BIN/$tool" --dump-cli man
done
mapfile -t verbs < <("$relief" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
[ ${#verbs[@]} -ge 6 ] || die "verbs: ${verbs[*]}"

# Every option that --help lists.
for page in relief relief-sim "${verbs[@]/#/relief-}"; do
    case $page in
    relief | relief-sim) command=("$RELIEF_BIN/$page") ;;
    *) command=("$relief" "${page#relief-}") ;;
    esac
    mapfile -t options < <("${command[@]}" --help | grep -oE '^  (-[a-zA-Z],)?--[a-z-]+|^  -[a-zA-Z]\b' | tr -d ' ' | tr , '\n')
    [ ${#options[@]} -ge 3 ] || die "$page --help: ${options[*]}"
    man -l "$page.1" | col -bx >text
    for option in "${options[@]}"; do
        grep -qE -- "^ .*$option([ ,]|\$)" text || die "$page(1) lacks $option"
    done
done

# Each option's help takes at most two lines of 120 columns, and each option of a verb has a heading. Details are in --manual.
for verb in "${verbs[@]}"; do
    "$relief" "$verb" --help >text
    awk '/^  relief / { next } /^  (-|[A-Z])/ { lines = 0 } length > 120 || (/^  / && ++lines > 2)' text >long
    [ ! -s long ] || die "$verb --help is too long: $(cat long)"
    ! grep -n '^Options:' text || die "$verb --help has options without a heading"
done
"$relief" bake --manual | matches '^ *center .*(cube)$' || die "bake --manual has no keys of --map"
expect 0 "$relief" check --manual # although FILE is missing

for page in *.1; do
    for formatter in "groff -man -Tutf8 -ww -K utf8" "man --warnings -l"; do
        # shellcheck disable=SC2086
        $formatter "$page" >text 2>warnings || die "$formatter $page fails"
        [ ! -s warnings ] || die "$formatter $page: $(cat warnings)"
        [ "$(wc -l <text)" -gt 20 ] || die "$formatter $page prints nothing"
    done
    # Pages have no date: equal sources give equal bytes.
    ! mandoc -Tlint -Wwarning "$page" | grep -v 'missing date' || die "mandoc reports warnings for $page"
    man -l "$page" | matches -E '^EXIT STATUS' || die "$page has no exit status"
done
man -l relief-bake.1 | col -b | matches 'relief bake bunny.obj$' || die "no example in relief-bake(1)"

# bash: the completion runs the programs.
PATH=$RELIEF_BIN:$PATH
touch a.relief b.toml && mkdir folder
cat >complete.bash <<'B'
# complete.bash COMPLETION WORD…: prints the completions of the last word.
source "$1"
shift
COMP_WORDS=("$@")
COMP_CWORD=$(($# - 1))
COMPREPLY=()
"$(complete -p "$1" | sed -E 's/.*-F ([^ ]+).*/\1/')"
printf '%s\n' "${COMPREPLY[@]}" | sort | tr '\n' ' '
B
completes() { # EXPECTED WORD…
    local got
    got=$(bash complete.bash "$completion" "${@:2}")
    [ "$got" = "$1 " ] || die "'${*:2}' completes to '$got' instead of '$1'"
}
completes "$(printf '%s\n' "${verbs[@]}" | sort | tr '\n' ' ' | sed 's/ $//')" relief ''
completes bake relief ba
completes 'best fast normal' relief bake m.obj --quality ''
completes 'auto shell solid terrain' relief bake m.obj --as ''
completes fast relief bake m.obj --quality f
completes 'best fast normal' relief bake m.obj --quality =
completes best relief bake m.obj --quality = b
completes --quality relief bake --qual
completes 'x y z' relief slice a.relief --axis ''
completes a.relief relief info a.r
completes a.relief relief bake -o a.r
completes '' relief bake --budget ''
completes '--samples --seed' relief check a.relief --s
completes '--version' relief --v
completes 'gl gles' relief-sim a.relief --api ''
completes folder relief-sim --frames f
completes b.toml relief-sim b
