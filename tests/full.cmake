# What looks at the program from outside: texts, an installed tree, a browser, a cluster. Of these
# `./test` runs those without the label `full`.
function(jvari_full)  # NAMES ...: tests of `./test all` alone
    foreach(name IN LISTS ARGN)
        get_test_property(${name} LABELS labels)
        if(NOT labels)
            set(labels gate)
        endif()
        set_tests_properties(${name} PROPERTIES LABELS "${labels};full")
    endforeach()
endfunction()

# The example plugin, and below the engine as somebody else's library: install to a scratch prefix,
# build out of tree against it, run.
set(prefix ${CMAKE_BINARY_DIR}/install_tree)
add_test(NAME installed COMMAND ${CMAKE_COMMAND} --install ${CMAKE_BINARY_DIR} --prefix ${prefix})
set_tests_properties(installed PROPERTIES FIXTURES_SETUP installed)
jvari_full(installed)
# FOLDER DEFINITIONS ...: tests/FOLDER in BUILD/FOLDER: the tests FOLDER.configure and FOLDER.build
function(jvari_out_of_tree folder)
    add_test(NAME ${folder}.configure
        COMMAND ${CMAKE_COMMAND} -G ${CMAKE_GENERATOR} -S ${CMAKE_CURRENT_SOURCE_DIR}/${folder}
            -B ${CMAKE_BINARY_DIR}/${folder} -DCMAKE_PREFIX_PATH=${prefix}
            -DCMAKE_BUILD_TYPE=${CMAKE_BUILD_TYPE} -DCMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS}
            -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER} ${ARGN})
    add_test(NAME ${folder}.build COMMAND ${CMAKE_COMMAND} --build ${CMAKE_BINARY_DIR}/${folder})
    set_tests_properties(${folder}.configure PROPERTIES FIXTURES_REQUIRED installed FIXTURES_SETUP
        ${folder}_configured)
    set_tests_properties(${folder}.build PROPERTIES FIXTURES_REQUIRED ${folder}_configured
        FIXTURES_SETUP ${folder}_built)
    jvari_full(${folder}.configure ${folder}.build)
endfunction()
jvari_out_of_tree(plugin)
set(plugin ${CMAKE_BINARY_DIR}/plugin/libplain_two_point.so)
add_executable(plugin_test EXCLUDE_FROM_ALL plugin_test.cpp)
add_dependencies(full plugin_test)
target_link_libraries(plugin_test PRIVATE jvari::schemes GTest::gtest_main)
add_test(NAME plugin_test COMMAND plugin_test --gtest_brief=1)
set_tests_properties(plugin_test PROPERTIES FIXTURES_REQUIRED plugin_built ENVIRONMENT
    JVARI_EXAMPLE_PLUGIN=${plugin})
add_test(NAME Plugin.ExportsNothingButItsTable
    COMMAND sh -c
        "test 1 = $(nm -D --defined-only $1 | grep jvari | tee /dev/stderr | grep -vc __odr_asan)"
        check ${plugin})
set_tests_properties(Plugin.ExportsNothingButItsTable PROPERTIES FIXTURES_REQUIRED plugin_built)
jvari_full(plugin_test Plugin.ExportsNothingButItsTable)
if(JVARI_PYTHON)
    add_test(NAME Python.TheModuleIsTheEngine COMMAND ${Python_EXECUTABLE} -B
        ${CMAKE_CURRENT_SOURCE_DIR}/python/module_test.py $<TARGET_FILE:jvari> ${plugin})
    add_test(NAME Python.SchemesOfOnesOwnAreJudgedAndChecked COMMAND ${Python_EXECUTABLE} -B
        ${CMAKE_CURRENT_SOURCE_DIR}/python/own_scheme_test.py)
    add_test(NAME Python.TheExampleDrawsTheCommittedStudy COMMAND ${Python_EXECUTABLE} -B
        ${CMAKE_CURRENT_SOURCE_DIR}/python/example_test.py ${CMAKE_SOURCE_DIR})
    set_tests_properties(Python.TheModuleIsTheEngine PROPERTIES FIXTURES_REQUIRED plugin_built)
    set_tests_properties(Python.TheModuleIsTheEngine Python.SchemesOfOnesOwnAreJudgedAndChecked
        Python.TheExampleDrawsTheCommittedStudy
        PROPERTIES ENVIRONMENT "PYTHONPATH=$<TARGET_FILE_DIR:jvari_python>;JVARI_CACHE="
        SKIP_RETURN_CODE 77 TIMEOUT 600)
    jvari_full(Python.TheModuleIsTheEngine Python.SchemesOfOnesOwnAreJudgedAndChecked
        Python.TheExampleDrawsTheCommittedStudy)
endif()

if(under_sanitizers)  # once is enough for what follows
    return()
endif()

if(JVARI_PYTHON)
    add_test(NAME Python.ScriptsBesideTheRecordsWriteTheirVerdicts COMMAND ${Python_EXECUTABLE} -B
        ${CMAKE_CURRENT_SOURCE_DIR}/python/records_test.py ${CMAKE_SOURCE_DIR})
    set_tests_properties(Python.ScriptsBesideTheRecordsWriteTheirVerdicts PROPERTIES
        ENVIRONMENT "PYTHONPATH=$<TARGET_FILE_DIR:jvari_python>;JVARI_CACHE=" SKIP_RETURN_CODE 77
        TIMEOUT 1200 COST 100)
    jvari_full(Python.ScriptsBesideTheRecordsWriteTheirVerdicts)
endif()

# These make many runs, or call compilers. CI runs them, too, as it does the long tests of the
# programs and of tests/fuzz.
set(long contract_test.numbers ContractPlugin.deaf Problems.AreWhatTheProgramExports
    OwnScheme.ItsTracesAreJudgedAndBadOnesAreRefused Plugin.AnyCompilerAndAnyHeaderOfTheVersion)
jvari_full(${long})
set_property(TEST ${long} APPEND PROPERTY LABELS long)

set(demo_report ${CMAKE_CURRENT_BINARY_DIR}/demo_report)
jvari_gate(Demo.AnswersInThirtyThreeLinesAndThirtySeconds demo.sh $<TARGET_FILE:jvari>
    ${demo_report})
set_tests_properties(Demo.AnswersInThirtyThreeLinesAndThirtySeconds PROPERTIES COST 100
    RUN_SERIAL TRUE FIXTURES_SETUP demo_report)  # its limit is one of processor time
jvari_full(Demo.AnswersInThirtyThreeLinesAndThirtySeconds)
jvari_gate(Browser.ThePageDrawsWhatItsTablesHold browser/page.sh $<TARGET_FILE:jvari>
    ${CMAKE_CURRENT_SOURCE_DIR}/report ${CMAKE_SOURCE_DIR}/bench/report/page
    ${CMAKE_SOURCE_DIR}/node_modules)
jvari_gate(Browser.AReportIsDrawnSoundsAndFitsAPhone browser/check.sh $<TARGET_FILE:jvari>
    ${CMAKE_CURRENT_SOURCE_DIR}/report ${CMAKE_SOURCE_DIR}/node_modules ${demo_report})
set_tests_properties(Browser.AReportIsDrawnSoundsAndFitsAPhone PROPERTIES COST 100 LABELS browser
    TIMEOUT 1500 FIXTURES_REQUIRED demo_report)
jvari_gate(Browser.EverySceneOfTheLibraryIsHeard browser/sounds.sh $<TARGET_FILE:jvari>)
set_tests_properties(Browser.EverySceneOfTheLibraryIsHeard PROPERTIES LABELS browser)
jvari_full(Browser.AReportIsDrawnSoundsAndFitsAPhone Browser.EverySceneOfTheLibraryIsHeard)

# The module of the page, where the preset web has been built.
jvari_gate(Web.EverySchemeGivesTheProgramsNumbersAndSentences web/check.sh agree.mjs
    $<TARGET_FILE:jvari> ${CMAKE_SOURCE_DIR}/build/web ${CMAKE_SOURCE_DIR})
set_tests_properties(Web.EverySchemeGivesTheProgramsNumbersAndSentences PROPERTIES COST 100 LABELS
    web)
jvari_gate(Web.ThePlaygroundShowsSoundsAndIsWalked web/check.sh page.mjs $<TARGET_FILE:jvari>
    ${CMAKE_SOURCE_DIR}/build/web ${CMAKE_SOURCE_DIR} ${CMAKE_SOURCE_DIR}/node_modules)
set_tests_properties(Web.ThePlaygroundShowsSoundsAndIsWalked PROPERTIES COST 100 LABELS web)
if(JVARI_PYTHON)
    set(python_module $<TARGET_FILE_DIR:jvari_python> ${Python_EXECUTABLE})
endif()
jvari_gate(Web.WhatIsTakenCompilesAndPlaysTheString web/check.sh take.mjs $<TARGET_FILE:jvari>
    ${CMAKE_SOURCE_DIR}/build/web ${CMAKE_SOURCE_DIR} ${prefix} ${python_module})
set_tests_properties(Web.WhatIsTakenCompilesAndPlaysTheString PROPERTIES
    FIXTURES_REQUIRED installed)
jvari_gate(Web.TheKeptPagesAreOfTheseSources web/hosted.sh ${CMAKE_SOURCE_DIR})
jvari_full(Web.EverySchemeGivesTheProgramsNumbersAndSentences
    Web.WhatIsTakenCompilesAndPlaysTheString
    Web.ThePlaygroundShowsSoundsAndIsWalked)

jvari_gate(FirstMinutes.FromANewSceneToAnAnswerInFiveCommands first_minutes.sh $<TARGET_FILE:jvari>)
jvari_gate(NewScheme.IsOneFileAndOneLine new_scheme.sh ${CMAKE_BINARY_DIR})
set_tests_properties(FirstMinutes.FromANewSceneToAnAnswerInFiveCommands
    NewScheme.IsOneFileAndOneLine PROPERTIES COST 100)
if(NOT CMAKE_GENERATOR MATCHES Ninja)
    # it asks ninja how things are linked
    set_tests_properties(NewScheme.IsOneFileAndOneLine PROPERTIES DISABLED TRUE)
endif()
jvari_gate(Docker.TheImageIsBuiltAsTheDemoIs dockerfile.sh $<TARGET_FILE:jvari>)
jvari_gate(Prose.SentencesAreShortLinksLeadSomewhereTermsAreInTheGlossary prose.sh)
jvari_gate(Comments.NameThingsInsteadOfPointingAtThem pointer_words.sh)
jvari_gate(Sources.NamesAreNounsSignpostsLeadSomewhereFunctionsAreShort sources.sh)
jvari_gate(Spelling.EveryWordIsEnglishOrTheFields spelling.sh)
jvari_gate(Format.EverySourceIsAsClangFormatLeavesIt format.sh)
jvari_full(FirstMinutes.FromANewSceneToAnAnswerInFiveCommands NewScheme.IsOneFileAndOneLine)
if(CMAKE_BUILD_TYPE STREQUAL Release)
    jvari_gate(Tidy.RoomsAndHeadersAreAsClangTidyWantsThem tidy.sh ${CMAKE_BINARY_DIR} rooms)
    set_tests_properties(Tidy.RoomsAndHeadersAreAsClangTidyWantsThem PROPERTIES COST 200 PROCESSORS
        2 TIMEOUT 1500)
    jvari_full(Tidy.RoomsAndHeadersAreAsClangTidyWantsThem)
endif()

jvari_out_of_tree(consumer)
add_test(NAME Installed.TheEngineIsALibraryForAnyProgram COMMAND
    ${CMAKE_BINARY_DIR}/consumer/consumer)
set_tests_properties(Installed.TheEngineIsALibraryForAnyProgram PROPERTIES FIXTURES_REQUIRED
    consumer_built)
# The schemes alone, where no library can be found but the two that they need.
foreach(library libhwy tomlplusplus)
    pkg_get_variable(folder ${library} pcfiledir)
    file(COPY ${folder}/${library}.pc DESTINATION ${CMAKE_CURRENT_BINARY_DIR}/needed)
endforeach()
foreach(library GSL Eigen3 CLI11 nlohmann_json fmt SUNDIALS)
    list(APPEND without -DCMAKE_DISABLE_FIND_PACKAGE_${library}=ON)
endforeach()
jvari_out_of_tree(host ${without})
set_tests_properties(host.configure PROPERTIES ENVIRONMENT
    PKG_CONFIG_LIBDIR=${CMAKE_CURRENT_BINARY_DIR}/needed)
jvari_gate(Installed.TheSchemesAloneNeedNoLibraryUnderTheGpl host/check.sh $<TARGET_FILE:jvari>
    ${CMAKE_BINARY_DIR}/host/host ${prefix})
set_tests_properties(Installed.TheSchemesAloneNeedNoLibraryUnderTheGpl PROPERTIES FIXTURES_REQUIRED
    host_built)
# The same libraries for other systems.
jvari_out_of_tree(elsewhere ${without})
set_tests_properties(elsewhere.configure PROPERTIES ENVIRONMENT
    PKG_CONFIG_LIBDIR=${CMAKE_CURRENT_BINARY_DIR}/needed)
foreach(system arm64 windows libcxx)
    jvari_gate(Elsewhere.TheSchemesPlayTheSameOn.${system} elsewhere.sh ${system} ${prefix}
        ${CMAKE_BINARY_DIR}/elsewhere.${system})
    set_tests_properties(Elsewhere.TheSchemesPlayTheSameOn.${system} PROPERTIES COST 200
        TIMEOUT 1800 FIXTURES_REQUIRED elsewhere_built)
    jvari_full(Elsewhere.TheSchemesPlayTheSameOn.${system})
endforeach()
jvari_gate(Installed.AllThatIsInstalledIsMadeWithTheProgram installable.sh ${CMAKE_BINARY_DIR})
jvari_gate(Installed.TheDebianPackageHoldsWhatItNeeds package.sh ${CMAKE_BINARY_DIR})
jvari_full(Installed.TheEngineIsALibraryForAnyProgram
    Installed.TheSchemesAloneNeedNoLibraryUnderTheGpl Installed.TheDebianPackageHoldsWhatItNeeds)

jvari_plugin(held_plugin slurm/held_scheme.cpp)
jvari_gate(Slurm.ASuiteSurvivesALostNodeAndALostTask slurm/check.sh $<TARGET_FILE:jvari>
    $<TARGET_FILE:held_plugin>)
set_tests_properties(Slurm.ASuiteSurvivesALostNodeAndALostTask PROPERTIES COST 100)
jvari_full(Slurm.ASuiteSurvivesALostNodeAndALostTask)
set_target_properties(deaf_plugins held_plugin thirty_per_cent_slow PROPERTIES EXCLUDE_FROM_ALL
    TRUE)
add_dependencies(full deaf_plugins held_plugin thirty_per_cent_slow)
