# Manual pages and completions, made from the definition of the command line: formatters and shells accept them, each has
# every option of every --help, and bash and fish complete verbs, options and values.
. "$(dirname "$0")/lib.sh"

"$RELIEF_BIN/relief-pages" pages
"$RELIEF_BIN/relief-pages" again
diff -r pages again || die "the pages are not the same twice"
expect_error 1 'FOLDER' "$RELIEF_BIN/relief-pages"
cp pages/*/man/man1/*.1 .
for tool in relief relief-sim; do
    # The build makes the same page, to be installed.
    diff -r pages/$tool "$RELIEF_BIN/../install/pages/$tool" || die "the build has other pages"
    cp pages/$tool/bash-completion/completions/$tool $tool.bash
    cp pages/$tool/zsh/site-functions/_$tool $tool.zsh
    cp pages/$tool/fish/vendor_completions.d/$tool.fish .
    # The installed programs do not make pages.
    expect 1 "$RELIEF_BIN/$tool" --dump-cli man
done
mapfile -t verbs < <("$relief" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
[ ${#verbs[@]} -ge 6 ] || die "verbs: ${verbs[*]}"

# Every option, as a person finds it in --help.
for page in relief relief-sim "${verbs[@]/#/relief-}"; do
    case $page in
    relief | relief-sim) command=("$RELIEF_BIN/$page") tool=$page verb='' ;;
    *) command=("$relief" "${page#relief-}") tool=relief verb=${page#relief-} ;;
    esac
    mapfile -t options < <("${command[@]}" --help | grep -oE '^  (-[a-zA-Z],)?--[a-z-]+|^  -[a-zA-Z]\b' | tr -d ' ' | tr , '\n')
    [ ${#options[@]} -ge 3 ] || die "$page --help: ${options[*]}"
    man -l "$page.1" | col -b >text
    for option in "${options[@]}"; do
        grep -qE -- "^ .*$option([ ,]|\$)" text || die "$page(1) lacks $option"
        grep -qE -- "[ ']$option[ ']" $tool.bash || die "$tool.bash lacks $option"
        grep -qF -- "$option[" $tool.zsh || die "$tool.zsh lacks $option"
        flag="-s ${option#-}"
        [[ $option != --* ]] || flag="-l ${option#--}"
        grep -qE -- "^complete -c $tool.*${verb:+_from $verb.*} $flag( |\$)" $tool.fish || die "$tool.fish lacks $option of '$verb'"
    done
done

for page in *.1; do
    for formatter in "groff -man -Tutf8 -ww -K utf8" "man --warnings -l"; do
        # shellcheck disable=SC2086
        $formatter "$page" >text 2>warnings || die "$formatter $page fails"
        [ ! -s warnings ] || die "$formatter $page: $(cat warnings)"
        [ "$(wc -l <text)" -gt 20 ] || die "$formatter $page prints nothing"
    done
    # Pages have no date: the same sources give the same bytes.
    ! mandoc -Tlint -Wwarning "$page" | grep -v 'missing date' || die "mandoc finds fault with $page"
    man -l "$page" | matches -E '^EXIT STATUS' || die "$page has no exit status"
done
man -l relief-bake.1 | col -b | matches 'relief bake bunny.obj -o bunny.relief$' || die "no example in relief-bake(1)"

# bash.
bash -n relief.bash && bash -n relief-sim.bash || die "bash does not parse its completion"
touch a.relief b.toml && mkdir folder
cat >complete.bash <<'B'
# complete.bash FILE WORD…: what the last word would be completed to.
source "$1"
shift
COMP_WORDS=("$@")
COMP_CWORD=$(($# - 1))
COMPREPLY=()
"$(complete -p "$1" | sed -E 's/.*-F ([^ ]+).*/\1/')"
printf '%s\n' "${COMPREPLY[@]}" | sort | tr '\n' ' '
B
completes() { # FILE EXPECTED WORD…
    local got
    got=$(bash complete.bash "$1" "${@:3}")
    [ "$got" = "$2 " ] || die "'${*:3}' completes to '$got' instead of '$2'"
}
completes relief.bash "$(printf '%s\n' "${verbs[@]}" | sort | tr '\n' ' ' | sed 's/ $//')" relief ''
completes relief.bash bake relief ba
completes relief.bash 'best fast normal' relief bake m.obj --quality ''
completes relief.bash 'auto shell solid terrain' relief bake m.obj --as ''
completes relief.bash fast relief bake m.obj --quality f
completes relief.bash 'best fast normal' relief bake m.obj --quality =
completes relief.bash best relief bake m.obj --quality = b
completes relief.bash --quality relief bake --qual
completes relief.bash 'x y z' relief slice a.relief --axis ''
completes relief.bash a.relief relief info a.r
completes relief.bash a.relief relief bake -o a.r
completes relief.bash '' relief bake --budget ''
completes relief.bash '--samples --seed' relief check a.relief --s
completes relief.bash '--version' relief --v
completes relief-sim.bash 'gl gles' relief-sim a.relief --api ''
completes relief-sim.bash folder relief-sim --frames f
completes relief-sim.bash b.toml relief-sim b

# fish, and zsh as far as it tells without a terminal.
export HOME=$work
for tool in relief relief-sim; do
    fish --no-execute $tool.fish || die "fish does not parse $tool.fish"
    zsh -n $tool.zsh || die "zsh does not parse $tool.zsh"
    head -1 $tool.zsh | matches -x "#compdef $tool" || die "$tool.zsh does not say what it completes"
done
fish_completes() { # FILE EXPECTED LINE
    local got
    got=$(fish -c "source $1; complete -C '$3'" | cut -f1 | sort | tr '\n' ' ')
    [ "$got" = "$2 " ] || die "fish completes '$3' to '$got' instead of '$2'"
}
fish_completes relief.fish 'best fast normal' 'relief bake m.obj --quality '
fish_completes relief.fish bake 'relief ba'
fish_completes relief.fish '--samples --seed' 'relief check --s'
fish_completes relief-sim.fish 'gl gles' 'relief-sim --api '
