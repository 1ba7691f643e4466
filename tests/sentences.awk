# The sentences of Markdown files, one a line: FILE:LINE, a tab, the sentence. LINE is where its
# paragraph, list item or table row begins. Left out: blocks of code, HTML comments, rules of
# tables. A span of code becomes the one word CODE, a link its text.
function sentences(text, where, parts, n, i) {
    gsub(/<[^ >][^>]*>/, "", text)
    gsub(/`[^`]*`/, "CODE", text)
    while (match(text, /!?\[[^]]*\]\([^)]*\)/)) {
        link = substr(text, RSTART, RLENGTH)
        sub(/^!?\[/, "", link)
        sub(/\]\([^)]*\)$/, "", link)
        text = substr(text, 1, RSTART - 1) link substr(text, RSTART + RLENGTH)
    }
    gsub(/\*\*|\*/, "", text)
    gsub(/\.\.\./, "…", text)
    while (match(text, /(^|[ (])(al|eqs?|figs?|pp|vol|no|ed|e\.g|i\.e|ch|Proc|Int|Conf|Soc|Am)\. /))
        text = substr(text, 1, RSTART + RLENGTH - 3) " " substr(text, RSTART + RLENGTH)
    gsub(/[.!?]["”)]* +/, "&\n", text)
    n = split(text, parts, / *\n/)
    for (i = 1; i <= n; ++i)
        if (parts[i] ~ /[A-Za-z0-9]/) print where "\t" parts[i]
}
function flush(cells, n, i) {
    if (block ~ /^ *\|/) {
        gsub(/\\\|/, "/", block)
        n = split(block, cells, "|")
        for (i = 1; i <= n; ++i) sentences(cells[i], place)
    } else if (block != "") {
        sentences(block, place)
    }
    block = ""
}
FNR == 1 { flush(); fenced = code = comment = 0; blank = 1 }
/^ *```/ { flush(); fenced = !fenced; next }
fenced { next }
/^<!--/ { flush(); comment = 1 }
comment { if (/-->/) comment = 0; next }
/^ *$/ { flush(); blank = 1; next }
/^    / && (blank || code) { code = 1; blank = 0; next }
{ code = 0; starts = blank; blank = 0 }
/^ *\|[-:| ]+$/ { flush(); next }
/^#/ || /^ *\|/ || /^ *[-*] / || /^ *[0-9]+\. / || starts { flush(); place = FILENAME ":" FNR }
{
    line = $0
    sub(/^#+ */, "", line)
    sub(/^ *([-*]|[0-9]+\.) /, "", line)
    sub(/^ +/, "", line)
    block = block == "" ? line : block " " line
}
/^#/ || /^ *\|/ { flush() }
END { flush() }
