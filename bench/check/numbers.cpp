#include "bench/check/numbers.hpp"

#include <vector>

#include "scenes/schema.hpp"

namespace jvari::bench::check {

namespace {
struct Change {
    int left;      // numbers before the one that is changed
    double tenth;  // its sign is the direction
    std::string key{}, path{};

    bool is_it(const char* name) {
        if (left-- != 0) return false;
        key = path + name;
        return true;
    }
    double other(double x, const std::string& unit) const {
        const double of = x != 0                       ? x
                          : unit == "m" || unit == "s" ? 1e-3
                          : unit == "N m^2"            ? 1e-3
                                                       : 1;
        return x + tenth * of;
    }
    void number(const char* name, double& x, const Range&, const char* unit, auto&&...) {
        if (is_it(name)) x = other(x, unit);
    }
    void stiffness(const char* name, double& k, const char* unit) {
        if (k != rigid) number(name, k, positive, unit);
    }
    void tension(String& s) { number("tension", s.tension, positive, "N"); }
    void count(const char* name, int& n) {
        if (is_it(name)) n += 1;
    }
    void columns(const char* name, const std::string&, const Column& first, std::vector<double>& a,
                 const Column& second, std::vector<double>& b) {
        for (const auto& [column, values] : {std::pair{first, &a}, {second, &b}})
            if (is_it(name)) {
                key += std::string(".") + column.name;
                for (double& x : *values) x = other(x, x == 0 ? "m" : "");
            }
    }
    void one_of(const char*, auto& variant, auto&&...) {
        std::visit([this](auto& alternative) { fields(*this, alternative); }, variant);
    }
    void part(const char* name, auto& p) {
        const std::string outside = path;
        path += std::string(name) + ".";
        if constexpr (requires { p.has_value(); }) {
            if (p) fields(*this, *p);
        } else {
            fields(*this, p);
        }
        path = outside;
    }
    void parts(const char* name, auto& all) {
        for (std::size_t i = 0; i < all.size(); ++i)
            part((std::string(name) + "." + std::to_string(i)).c_str(), all[i]);
    }
    void material() {}
    void file(auto&&...) {}
    void text(auto&&...) {}
    void optional_text(auto&&...) {}
    void choice(auto&&...) {}
    void refused(auto&&...) {}
    void string_index(auto&&...) {}
};
}  // namespace

std::optional<Changed> changed(const Scene& scene, int which, bool down) {
    Changed c{"", scene};
    Change change{which, down ? -0.1 : 0.1};
    fields(change, c.scene);
    if (change.key.empty()) return std::nullopt;
    c.key = change.key;
    return c;
}

}  // namespace jvari::bench::check
