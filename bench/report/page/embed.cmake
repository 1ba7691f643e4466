# The files of the page as text in the program, so that it has no file to look for when it runs:
# -DFOLDER -DOUT, every file but this one.
file(GLOB files "${FOLDER}/*.html" "${FOLDER}/*.css" "${FOLDER}/*.js")
list(SORT files)
string(CONCAT text "#include \"bench/report/report.hpp\"\n\nnamespace jvari::bench::report {\n"
    "namespace {\nconstexpr PageText texts[] = {\n")
foreach(file IN LISTS files)
    get_filename_component(name "${file}" NAME)
    file(READ "${file}" content)
    string(APPEND text "    {\"${name}\", R\"page_text(${content})page_text\"},\n")
endforeach()
string(APPEND text
    "};\n}  // namespace\n\nstd::span<const PageText> page_texts() {\n    return texts;\n}\n\n"
    "}  // namespace jvari::bench::report\n")
file(WRITE "${OUT}" "${text}")
