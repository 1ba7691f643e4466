// Feeds scene_fuzz.cpp the library's scenes, mutated by a fixed seed: the same inputs on every machine (std::mt19937_64 is specified to the
// bit).
//   scene_fuzz COUNT DIRECTORY
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {
struct Mutator {
    const std::vector<std::string>& corpus;
    std::mt19937_64 engine{20160905};

    std::size_t below(std::size_t n) { return n ? engine() % n : 0; }
    const std::string& any(const std::vector<std::string>& from) { return from[below(from.size())]; }

    static const std::vector<std::string>& words() {
        static const std::vector<std::string> all{"nan",
                                                  "inf",
                                                  "-inf",
                                                  "-1",
                                                  "0",
                                                  "1e308",
                                                  "5e-324",
                                                  "9223372036854775807",
                                                  "99999999999999999999",
                                                  "1.7976931348623157e308",
                                                  "true",
                                                  "1979-05-27",
                                                  "\"\"",
                                                  "\"\\u0000\"",
                                                  "[]",
                                                  "{}",
                                                  "[[string]]",
                                                  "[string]",
                                                  "[[string.barrier]]",
                                                  "[string.thread]",
                                                  "[string.damping]",
                                                  "[body]",
                                                  "\nbridge=\"x\"\n",
                                                  "[[tap]]",
                                                  "\nlaw = \"table\"\nfile = \"scenes\"\n",
                                                  "law = \"none\"",
                                                  "curve = \"table\"",
                                                  "shape",
                                                  "position",
                                                  "a.b.c.d.e",
                                                  "\"\"\"",
                                                  "'''",
                                                  "#",
                                                  "=",
                                                  ".",
                                                  "\n",
                                                  "\xff",
                                                  "\xef\xbb\xbf",
                                                  "\r",
                                                  std::string("\0string.0.tension=", 18),
                                                  std::string("\0string.0.damping.law=none", 26),
                                                  std::string("\0string.1.length=1", 18),
                                                  std::string("\0tap.7=", 7)};
        return all;
    }

    void mutate(std::string& s) {
        const std::size_t at = below(s.size() + 1), length = std::min(below(40), s.size() - at);
        const auto line = [&](std::size_t i) { return std::min(s.find('\n', i), s.size()); };
        switch (below(9)) {
            case 0: s.insert(at, any(words())); break;
            case 1: s.replace(at, length, any(words())); break;
            case 2: s.erase(at, length); break;
            case 3: s.insert(below(s.size() + 1), s.substr(at, length)); break;
            case 4:
                if (at < s.size()) s[at] = static_cast<char>(below(256));
                break;
            case 5: s.erase(at, line(at) - at); break;                                     // the rest of a line
            case 6: s.insert(line(below(s.size() + 1)), s.substr(at, below(200))); break;  // a piece behind another line
            case 7: {                                                                      // a value
                const std::size_t equals = std::min(s.find('=', at), s.size());
                if (equals < s.size()) s.replace(equals + 1, line(equals) - equals - 1, " " + any(words()));
                break;
            }
            default: {  // the tail of another scene
                const std::string& other = any(corpus);
                s = s.substr(0, at) + other.substr(std::min(at, other.size()));
            }
        }
    }
};

std::vector<std::string> nested() {  // as deep as the limits on dots and brackets let through
    std::string keys, table = "x=[\n", ends = "]\n";
    for (int i = 0; i < 64; ++i) keys += "a.";
    for (int i = 0; i < 127; ++i) {
        table += "{" + keys + "a=[\n";
        ends = "]}" + ends;
    }
    return {"x=" + std::string(100000, '['), "[" + keys + "a]\n" + keys + "a = 1\n", table, table + ends, keys + keys + "a=1",
            std::string(1 << 20, 'a'),       std::string(1 << 20, '\n') + "a"};
}
}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return std::fprintf(stderr, "usage: scene_fuzz COUNT DIRECTORY\n"), 2;
    const auto feed = [](const std::string& s) { LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(s.data()), s.size()); };
    std::vector<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::directory_iterator(argv[2]))
        if (entry.path().extension() == ".toml") paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    std::vector<std::string> corpus;
    for (const auto& path : paths) {
        std::ifstream in(path, std::ios::binary);
        corpus.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
    if (corpus.empty()) return std::fprintf(stderr, "no scenes in %s\n", argv[2]), 2;
    for (const std::string& s : nested()) feed(s);
    for (const std::string& s : corpus)  // cut everywhere
        for (std::size_t n = 0; n <= s.size(); n += 17) feed(s.substr(0, n));
    Mutator mutator{corpus};
    const long count = std::atol(argv[1]);
    for (long i = 0; i < count; ++i) {
        std::string s = mutator.any(corpus);
        for (std::size_t n = 1 + mutator.below(4); n > 0; --n) mutator.mutate(s);
        feed(s);
    }
    std::printf("%ld mutated scenes\n", count);
}
