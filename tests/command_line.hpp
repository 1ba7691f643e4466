// Runs the built program: arguments in; exit code, standard output and standard error out.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>

#include "tests/says.hpp"

namespace jvari::test {

inline std::string content(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

inline void overwrite(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

struct Scratch {  // a folder for one test
    Scratch() {
        std::string name = (std::filesystem::temp_directory_path() / "jvari-test-XXXXXX").string();
        if (mkdtemp(name.data())) path = name;
    }
    ~Scratch() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
    std::filesystem::path path;
    std::string operator/(const std::string& name) const { return (path / name).string(); }
    int files() const {
        int n = 0;
        for (const auto& entry : std::filesystem::directory_iterator(path))
            n += entry.path().filename() != "stdout" && entry.path().filename() != "stderr";
        return n;
    }
};

struct Ended {
    int code;
    std::string out, err;
};

// a failure says it on standard error
inline testing::AssertionResult ends(const Ended& of, int code, const std::string& message) {
    if (of.code != code)
        return testing::AssertionFailure() << "ends with " << of.code << ":\n" << of.out << of.err;
    return says(code ? of.err : of.out, message);
}

inline Ended jvari(const Scratch& scratch, const std::string& arguments,
                   const std::string& environment = "") {
    const std::string out = scratch / "stdout", err = scratch / "stderr";
    const int status = std::system(
        (environment + " " JVARI_PROGRAM " " + arguments + " >" + out + " 2>" + err + " </dev/null")
            .c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(out), content(err)};
}

// A suite of one set of cells: its lists, with commas, and further lines.
inline std::string suite_of(const std::string& scenes, const std::string& schemes,
                            const std::string& rates, const std::string& more) {
    const auto texts = [](const std::string& list) {
        return "[\"" + std::regex_replace(list, std::regex(","), "\", \"") + "\"]\n";
    };
    return "[[cells]]\nscenes = " + texts(scenes) + "schemes = " + texts(schemes) + "rates = [" +
           rates + "]\n" + more + "\n";
}

inline const std::string run_for = "$J run free_string --scheme modal_two_point --duration ",
                         small_run = run_for + "0.05";

// Runs lines of bash in the folder of the test, without charts and without kept runs; $J is the
// program.
inline Ended shell(const Scratch& scratch, const std::string& lines) {
    const std::string script = scratch / "script";
    std::ofstream(script) << "export J=" JVARI_PROGRAM
                             " JVARI_CACHE= JVARI_NODE_MODULES=/nowhere\nulimit -c 0\ncd "
                          << scratch.path.string() << "\n"
                          << lines << "\n";
    const int status = std::system(("bash " + script + " >" + (scratch / "stdout") + " 2>" +
                                    (scratch / "stderr") + " </dev/null")
                                       .c_str());
    std::filesystem::remove(script);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(scratch / "stdout"),
            content(scratch / "stderr")};
}

}  // namespace jvari::test
