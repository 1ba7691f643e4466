# Writes OUT with what this build is made of, from SOURCE; leaves OUT alone where nothing changed.
#   JVARI_COMMIT        git describe, "unknown" outside git: for people
#   JVARI_RUN_SOURCES   a hash of all that the numbers of a run depend on: scenes, schemes,
#                       references
#   JVARI_CELL_SOURCES  the same with what measures them: analysis, and every room of bench but
#                       those of text
set(commit "unknown")
find_program(git_program git)
if(git_program)
    execute_process(COMMAND ${git_program} -C ${SOURCE} describe --always --dirty --abbrev=12
        OUTPUT_VARIABLE described ERROR_QUIET RESULT_VARIABLE failed
            OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(NOT failed AND described)
        set(commit "${described}")
    endif()
endif()
function(hash_folders OUTPUT)
    set(all "")
    foreach(folder ${ARGN})
        file(GLOB_RECURSE files RELATIVE ${SOURCE} ${SOURCE}/${folder}/*.hpp
            ${SOURCE}/${folder}/*.cpp ${SOURCE}/${folder}/*.def)
        list(SORT files)
        foreach(file ${files})
            file(SHA256 ${SOURCE}/${file} hash)
            string(APPEND all "${file} ${hash}\n")
        endforeach()
    endforeach()
    string(SHA256 hash "${all}")
    string(SUBSTRING ${hash} 0 32 hash)
    set(${OUTPUT} ${hash} PARENT_SCOPE)
endfunction()
hash_folders(run_sources scenes schemes reference)
file(GLOB rooms RELATIVE ${SOURCE} ${SOURCE}/bench/*)
# no number that is kept is made there
list(FILTER rooms EXCLUDE REGEX "^bench/(report|command)$")
hash_folders(cell_sources scenes schemes reference analysis ${rooms})
string(CONCAT text "#define JVARI_COMMIT \"${commit}\"\n"
    "#define JVARI_RUN_SOURCES \"${run_sources}\"\n"
    "#define JVARI_CELL_SOURCES \"${cell_sources}\"\n")
set(old "")
if(EXISTS ${OUT})
    file(READ ${OUT} old)
endif()
if(NOT text STREQUAL old)
    file(WRITE ${OUT} "${text}")
endif()
