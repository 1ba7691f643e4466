// JUnit XML: the schema that continuous integration reads, https://github.com/testmoapp/junitxml.
#include "bench/check/check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "bench/store/json.hpp"

namespace jvari::bench::check {

namespace {
using Json = nlohmann::ordered_json;
using Answer = Verdict::Answer;

struct Count {
    int kept = 0, broken = 0, excused = 0, not_asked = 0;
    const Answered* first = nullptr;  // that has this answer, else any
    Answer answer() const {
        return broken > 0    ? Answer::broken
               : excused > 0 ? Answer::excused
               : kept > 0    ? Answer::kept
                             : Answer::not_asked;
    }
    int& of(Answer a) {
        return a == Answer::broken    ? broken
               : a == Answer::excused ? excused
               : a == Answer::kept    ? kept
                                      : not_asked;
    }
};
Count count_of(const Checked& c, const Promise& p) {
    Count n;
    for (const Answered& a : c.answers) {
        if (a.promise != &p) continue;
        if (++n.of(a.verdict.answer) == 1 && (!n.first || a.verdict.answer == n.answer()))
            n.first = &a;
    }
    return n;
}

std::string scenes_text(const Count& n) {
    if (!n.first || n.first->scene.empty()) return "";
    const int bad = n.broken + n.excused;  // of one scheme either
    return bad > 0 ? fmt::format("{} of {} scenes", bad, bad + n.kept)
                   : fmt::format("{} scenes", n.kept);
}
}  // namespace

bool Checked::broken() const {
    return std::any_of(answers.begin(), answers.end(),
                       [](const Answered& a) { return a.verdict.broken(); });
}

Checked check(const Descriptor& d, const store::Listener& listener,
              const std::function<void(const Checked&, const Promise&)>& answered) {
    Checked c{d.name, d.source, {}};
    const auto progress = listener.begin(std::string("check ") + d.name);
    double done = 0;
    std::string broken, claim_broken;  // the first promise that is, the first claim
    for (const Promise& p : promises()) {
        const auto cases = cases_of(d, p.asked);
        const bool last = p.asked == Asked::once_all_before_are_kept,
                   claim = last || p.asked == Asked::once_all_others_are_kept;
        const std::string& rests_on = last && broken.empty() ? claim_broken : broken;
        for (const Case& one : cases) {
            progress->show(done / promises().size(), p.name);
            const auto start = std::chrono::steady_clock::now();
            Verdict verdict =
                claim && !rests_on.empty() ? not_asked("it rests on " + rests_on) : ask(p, one);
            std::string& first = claim ? claim_broken : broken;
            if (first.empty() && verdict.broken()) first = p.name;
            const double seconds =
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            c.answers.push_back({&p, one.scene.name, std::move(verdict), seconds});
            done += 1.0 / cases.size();
        }
        if (answered) answered(c, p);
    }
    return c;
}

std::string line_of(const Checked& c, const Promise& p) {
    const Count n = count_of(c, p);
    const bool tells = n.first && n.answer() == n.first->verdict.answer &&
                       !n.first->verdict.why.empty() &&
                       (n.answer() != Answer::kept || n.first->scene.empty());
    const std::string where =
        tells && !n.first->scene.empty() && n.broken + n.excused > 0 ? n.first->scene + ": " : "";
    const std::string scenes = scenes_text(n);
    return fmt::format("  {:<9}  {:<48}  {}{}{}", n.broken > 0 ? "BROKEN" : name_of(n.answer()),
                       p.name, scenes, tells && !scenes.empty() ? "; " : "",
                       tells ? where + n.first->verdict.why : "");
}

std::string conclusion_of(const Checked& c) {
    int broken = 0;
    std::string excused;
    for (const Promise& p : promises()) {
        const Count n = count_of(c, p);
        broken += n.broken > 0;
        if (n.excused > 0) excused += (excused.empty() ? "" : ", ") + std::string(p.name);
    }
    const std::string text =
        broken == 0 ? "  keeps what it promises"
                    : fmt::format("  breaks {} of {} promises", broken, promises().size());
    return text +
           (excused.empty() ? "" : fmt::format(", but for what it is known to break: {}", excused));
}

std::string json_of(const std::vector<Checked>& all) {
    Json schemes = Json::array();
    bool any = false;
    for (const Checked& c : all) {
        Json answers = Json::array();
        for (const Answered& a : c.answers)
            answers.push_back({{"promise", a.promise->name},
                               {"scene", a.scene},
                               {"answer", name_of(a.verdict.answer)},
                               {"why", a.verdict.why},
                               {"seconds", a.seconds}});
        Json broken = Json::array();
        for (const Promise& p : promises())
            if (count_of(c, p).broken > 0) broken.push_back(p.name);
        any = any || c.broken();
        schemes.push_back(
            {{"scheme", c.scheme}, {"source", c.source}, {"broken", broken}, {"answers", answers}});
    }
    return store::indented({{"status", any ? "broken" : "kept"}, {"schemes", schemes}});
}

std::string junit_of(const std::vector<Checked>& all) {
    std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
    for (const Checked& c : all) {
        const auto number = [&c](Answer answer) {
            return std::count_if(c.answers.begin(), c.answers.end(), [answer](const Answered& a) {
                return a.verdict.answer == answer;
            });
        };
        double seconds = 0;
        for (const Answered& a : c.answers) seconds += a.seconds;
        text += fmt::format(
            "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" skipped=\"{}\" "
            "time=\"{:.3f}\">\n",
            store::escaped(c.scheme), c.answers.size(), number(Answer::broken),
            number(Answer::excused) + number(Answer::not_asked), seconds);
        for (const Answered& a : c.answers) {
            text += fmt::format("    <testcase classname=\"{}.{}\" name=\"{}\" time=\"{:.3f}\"",
                                store::escaped(c.scheme), a.promise->name,
                                store::escaped(a.scene.empty() ? a.promise->sentence : a.scene),
                                a.seconds);
            const std::string why = store::escaped(a.verdict.why);
            if (a.verdict.answer == Answer::broken)
                text += fmt::format("><failure message=\"{}\"/></testcase>\n", why);
            else if (a.verdict.answer != Answer::kept)
                text += fmt::format("><skipped message=\"{}\"/></testcase>\n", why);
            else text += "/>\n";
        }
        text += "  </testsuite>\n";
    }
    return text + "</testsuites>\n";
}

}  // namespace jvari::bench::check
