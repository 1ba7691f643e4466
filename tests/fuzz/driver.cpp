// Feeds a target its corpus, mutated by a fixed seed: the same inputs on every machine
// (std::mt19937_64 is specified to the bit). It stands in for libFuzzer where the compiler has
// none; it knows nothing of coverage.
//   fuzz_NAME COUNT DICTIONARY CORPUS
#include <algorithm>
#include <iterator>
#include <random>
#include <vector>

#include "fuzz.hpp"

namespace jvari::test {
namespace {
std::string content(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void feed(const std::string& s) {
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(s.data()), s.size());
}

// Lines "word" of a libFuzzer dictionary, with \\ \" and \xFF in it.
std::vector<std::string> words_of(const std::filesystem::path& dictionary) {
    std::vector<std::string> words;
    std::ifstream in(dictionary);
    for (std::string line; std::getline(in, line);) {
        const std::size_t begin = line.find('"'), end = line.rfind('"');
        if (line[0] == '#' || begin == end) continue;
        std::string& word = words.emplace_back();
        for (std::size_t i = begin + 1; i < end; ++i) {
            if (line[i] != '\\') word += line[i];
            else if (line[i + 1] != 'x') word += line[++i];
            else word += static_cast<char>(std::stoi(line.substr(i + 2, 2), nullptr, 16)), i += 3;
        }
    }
    return words;
}

struct Mutator {
    const std::vector<std::string>& corpus;
    const std::vector<std::string>& words;
    std::mt19937_64 engine{20160905};

    std::size_t below(std::size_t n) { return n ? engine() % n : 0; }
    const std::string& any(const std::vector<std::string>& from) {
        return from[below(from.size())];
    }

    void mutate(std::string& s) {
        const std::size_t at = below(s.size() + 1), length = std::min(below(40), s.size() - at);
        const auto line = [&](std::size_t i) { return std::min(s.find('\n', i), s.size()); };
        switch (below(9)) {
            case 0: s.insert(at, any(words)); break;
            case 1: s.replace(at, length, any(words)); break;
            case 2: s.erase(at, length); break;
            case 3: s.insert(below(s.size() + 1), s.substr(at, length)); break;
            case 4:
                if (at < s.size()) s[at] = static_cast<char>(below(256));
                break;
            // the rest of a line
            case 5: s.erase(at, line(at) - at); break;
            // a piece behind another line
            case 6: s.insert(line(below(s.size() + 1)), s.substr(at, below(200))); break;
            // a value
            case 7: {
                const std::size_t value = s.find_first_of("=:,", at);
                if (value != std::string::npos)
                    s.replace(value + 1, s.find_first_of(",\n]}", value + 1) - value - 1,
                              any(words));
                break;
            }
            default: {  // the tail of another
                const std::string& other = any(corpus);
                s = s.substr(0, at) + other.substr(std::min(at, other.size()));
            }
        }
    }
};

// Too deep and too long for anybody.
std::vector<std::string> monsters() {
    return {std::string(200000, '['), "x=" + std::string(100000, '['), std::string(1 << 20, 'a'),
            std::string(1 << 20, '\n') + "a"};
}
}  // namespace
}  // namespace jvari::test

int main(int argc, char** argv) {
    using namespace jvari::test;
    if (argc != 4) return std::fprintf(stderr, "usage: fuzz_NAME COUNT DICTIONARY CORPUS\n"), 2;
    std::vector<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::directory_iterator(argv[3]))
        paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    const std::vector<std::string> words = words_of(argv[2]);
    std::vector<std::string> corpus;
    for (const auto& path : paths) {
        corpus.push_back(content(path));
        const long before = inputs_read;
        feed(corpus.back());
        if (path.filename().string().starts_with("good_"))
            promise(inputs_read > before, "a good seed is read", path.string());
    }
    promise(inputs_read > 0 && !words.empty(), "there is a good seed and a dictionary", argv[3]);
    for (const std::string& s : monsters()) feed(s);
    for (const std::string& s : corpus)  // cut everywhere
        for (std::size_t n = 0; n <= s.size(); n += 17) feed(s.substr(0, n));
    Mutator mutator{corpus, words};
    const long count = std::atol(argv[1]);
    for (long i = 0; i < count; ++i) {
        std::string s = mutator.any(corpus);
        for (std::size_t n = 1 + mutator.below(4); n > 0; --n) mutator.mutate(s);
        feed(s);
    }
    std::printf("%ld mutated inputs, %ld of all inputs read\n", count, inputs_read);
}
