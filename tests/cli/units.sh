# Units, axes and placements that a format states: boxes of every format, whose size is known, of random cases of a seed.
. "$(dirname "$0")/lib.sh"
export PYTHONPATH=$RELIEF_SOURCE/tests/cases PYTHONDONTWRITEBYTECODE=1

printf 'PK\3\4' >box.3mf
expect_error 5 "box.3mf.*no mesh format has the extension '.3mf'; convert it" "$relief" bake box.3mf -o x.relief

python3 "$RELIEF_SOURCE/tests/cases/units_cases.py" "$RELIEF_BIN" --seed "${RELIEF_TEST_SEED:-1}" --cases 24
