#!/usr/bin/env bash
# Tests that texts from files and names of folders reach no shell, no gnuplot command, no path and no page as code: the
# title of a scenario, names of SUMO's files, and the folder of the results.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
cd "$work" || exit 1

gnuplot="'; system('touch pwned'); set label \\\"\`touch pwned\`\\\""
page="</title></script><script>alert(1)</script><img src=x onerror=alert(1)>"
folder="$work/a'b \"c\" \$(touch pwned) \`touch pwned\`; touch pwned <b>"
mkdir "$folder" || exit 1

# A name without blanks, because routes are lists of names.
name="e\$(touch\${IFS}pwned)\`touch\${IFS}pwned\`;'|\"<script>alert(1)</script>/../../pwned"
name="$(sed 's/&/\&amp;/g; s/</\&lt;/g; s/>/\&gt;/g; s/"/\&quot;/g' <<<"$name")"
cat >"$folder/a.net.xml" <<END
<net>
<edge id="$name" from="A" to="B"><lane id="${name}_0" index="0" speed="13.89" length="300" shape="0,0 300,0"/></edge>
<junction id="A" type="dead_end" x="0" y="0"/><junction id="B" type="dead_end" x="300" y="0"/>
</net>
END
cat >"$folder/a.rou.xml" <<END
<routes><route id="r" edges="$name"/><flow id="$name" route="r" begin="0" end="300" period="3"/></routes>
END

cat >"$folder/s.yaml" <<END
title: "$gnuplot $page"
fidelity: meso
duration: 300 s
network: {kind: sumo, net: ./a.net.xml, routes: [./a.rou.xml]}
populations: [CTG-Ref]
measure: {window: 200 s}
END
"$STOPLINE_BIN/stopline-run" "$folder/s.yaml" --record "$folder/s.rec" --fcd "$folder/fcd.xml" --tripinfo "$folder/trips.xml" \
    --output "$folder/out" >stdout 2>stderr || fail "run: exit code $?: $(head -c 500 stderr)"
"$STOPLINE_BIN/stopline-replay" "$folder/s.rec" --output "$folder/s.html" >stdout 2>stderr ||
    fail "replay: exit code $?: $(head -c 500 stderr)"
if command -v gnuplot >gnuplot_path; then [ -n "$(find "$folder/out" -name '*.svg')" ] || fail "there is no figure"; fi
[ -z "$(find "$work" -name '*pwned' -type f)" ] || fail "a text was executed: $(find "$work" -name '*pwned')"
grep -qF '<script>alert' "$folder/s.html" && fail "the page has a script from the title"
for file in fcd trips; do
    python3 -c 'import sys, xml.dom.minidom; xml.dom.minidom.parse(sys.argv[1])' "$folder/$file.xml" ||
        fail "$file.xml is not well-formed"
done

# Control characters of a file do not reach the terminal.
printf '<routes><trip id="t" from="no\302\23331mbody" to="x" depart="0"/></routes>' >"$folder/a.rou.xml"
"$STOPLINE_BIN/stopline-run" "$folder/s.yaml" --no-figures --output "$folder/out" >stdout 2>stderr
[ $? -eq 2 ] || fail "an unknown edge is accepted"
grep -qF "there is no edge 'no\\xC2\\x9B31mbody'" stderr || fail "the message is not printable: $(head -c 300 stderr)"
exit $((failures > 0))
