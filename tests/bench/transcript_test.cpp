// The command line by transcripts: commands, their output and their exit code (transcripts.txt).
#include <cctype>
#include <vector>

#include "tests/command_line.hpp"

namespace jvari::test {
namespace {

struct Command {
    std::string line;  // of bash
    std::vector<std::string> out, err, none;
    int code = 0;
};
struct Transcript {
    std::string name;
    std::vector<Command> commands;
    friend void PrintTo(const Transcript& t, std::ostream* to) { *to << t.name; }
};

std::vector<Transcript> transcripts() {
    std::vector<Transcript> all;
    std::ifstream file(JVARI_TRANSCRIPTS);
    bool head = true;  // comments before the first empty line
    for (std::string line; std::getline(file, line);) {
        head = head && !line.empty();
        if (head || line.empty()) continue;
        const std::string rest = line.substr(std::min<std::size_t>(2, line.size()));
        if (line.starts_with("# ")) {
            all.push_back({rest, {}});
        } else if (line.starts_with("$ ")) {
            all.back().commands.push_back({rest, {}, {}, {}});
        } else {
            Command& c = all.back().commands.back();
            if (line.front() == '[') c.code = std::stoi(line.substr(1));
            else if (line.starts_with("! ")) c.err.push_back(rest);
            else if (line.starts_with("~ ")) c.none.push_back(rest);
            else c.out.push_back(line);
        }
    }
    return all;
}

class Transcripts : public testing::TestWithParam<Transcript> {};
TEST_P(Transcripts, PrintAndEndAsWritten) {
    const Scratch scratch;
    for (const Command& c : GetParam().commands) {
        const Ended o = shell(scratch, "export STUMBLING_PLUGIN=" JVARI_STUMBLING_PLUGIN
                                       " BAD_PLUGIN=" JVARI_BAD_PLUGIN
                                       " UNOPTIMISED_PLUGIN=" JVARI_UNOPTIMISED_PLUGIN "\n" +
                                           c.line);
        EXPECT_EQ(o.code, c.code) << c.line << "\n" << o.err;
        for (const std::string& text : c.out) EXPECT_TRUE(says(o.out, text)) << c.line;
        for (const std::string& text : c.err) EXPECT_TRUE(says(o.err, text)) << c.line;
        for (const std::string& text : c.none)
            if (text == ".") EXPECT_EQ(o.out + o.err, "") << c.line;
            else EXPECT_FALSE(says(o.out + o.err, text)) << c.line;
    }
}
INSTANTIATE_TEST_SUITE_P(, Transcripts, testing::ValuesIn(transcripts()), [](const auto& one) {
    std::string name;
    for (bool begins = true; const char c : one.param.name) {
        if (c != ' ') name += begins ? static_cast<char>(std::toupper(c)) : c;
        begins = c == ' ';
    }
    return name;
});

}  // namespace
}  // namespace jvari::test
