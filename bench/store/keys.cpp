#include "bench/store/keys.hpp"

#include <cmath>

namespace jvari::bench::store {

namespace {
Kind<double> number_that(const char* says, const char* unit, bool (*holds)(double)) {
    const std::string expected = says + (*unit ? " [" + std::string(unit) + "]" : "");
    return {expected, [expected, holds](const Entry& e) {
                const auto x = e.number();
                if (!x || !std::isfinite(*x) || !holds(*x)) e.refuse(expected);
                return *x;
            }};
}
}  // namespace

Kind<std::string> text() {
    return {"a text", [](const Entry& e) { return e.text(); }};
}

Kind<std::string> name_of_file() {
    const char* says = "lower-case letters, digits, _ and -, for it names a file";
    return {
        says, [says](const Entry& e) {
            std::string name = e.text();
            if (name.empty() || name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-") !=
                                    std::string::npos)
                e.refuse(says);
            return name;
        }};
}

Kind<double> positive(const char* unit) {
    return number_that("a number > 0", unit, [](double x) { return x > 0; });
}

Kind<double> not_negative(const char* unit) {
    return number_that("a number >= 0", unit, [](double x) { return x >= 0; });
}

Kind<int> whole(int least, int most) {
    const std::string says =
        "a whole number from " + std::to_string(least) + " to " + std::to_string(most);
    return {says, [says, least, most](const Entry& e) {
                const auto n = e.whole();
                if (!n || *n < least || *n > most) e.refuse(says);
                return static_cast<int>(*n);
            }};
}

Kind<int> count() { return whole(1, most_counted); }

Kind<bool> yes_or_no() {
    return {"true or false", [](const Entry& e) { return e.truth(); }};
}

Kind<std::string> word(const char* what, const std::vector<std::string>& known) {
    std::vector<std::pair<std::string, std::string>> words;
    words.reserve(known.size());
    for (const std::string& w : known) words.emplace_back(w, w);
    return one_of(what, std::move(words));
}

}  // namespace jvari::bench::store
