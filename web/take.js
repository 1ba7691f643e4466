// "Take it": the string of the page as a file that compiles against the installed engine, and as a
// script for the Python module; each carries its error in a comment.
const cpp_word = text => JSON.stringify(text); // also a word in Python
// A raw string ends at the first `)scene"`, which no scene file has but in a comment.
const raw = text => text.replaceAll(')scene"', ") scene").replace(/\n*$/, "\n");
const wrapped = (text, mark, width = 96) =>
  text
    .split(/\s+/)
    .reduce(
      (lines, word) => {
        const longer = `${lines.at(-1)} ${word}`;
        if (longer.length + mark.length > width) lines.push(word);
        else lines[lines.length - 1] = longer;
        return lines;
      },
      [""],
    )
    .map(line => `${mark} ${line.trim()}`)
    .join("\n");

// `about`: the sentence with the error and the names of the tables; `text`, `overrides`: the scene
// and its changes; `tap`: the column that is heard.
const taken = {
  "C++"({about, text, overrides, scheme, rate, modes, options, tap}) {
    const pairs = options.map(o => `{${o.split("=").map(cpp_word).join(", ")}}`).join(", ");
    return `${wrapped(about, "//")}
//
// cmake_minimum_required(VERSION 3.25)
// project(string LANGUAGES C CXX)
// find_package(jvari REQUIRED COMPONENTS schemes)
// add_executable(string string.cpp)
// target_link_libraries(string PRIVATE jvari::schemes)
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <scenes/scene_file.hpp>
#include <schemes/registry.hpp>
#include <schemes/run.hpp>
#include <string>
#include <vector>

constexpr const char* scene_text = R"scene(
${raw(text)})scene";

jvari::Scene string() {
    return jvari::parse_scene(scene_text, "scene.toml", {${overrides.map(cpp_word).join(", ")}});
}

class Voice {
public:
    static constexpr int rows = 64;  // of a block, at ${rate} Hz

    Voice() : scene_(string()) {
        scene_.taps = {scene_.taps[${tap}]};
        sounding_ = made(scene_);
        scene_.strings[0].pluck.reset();
    }
    // Plucks the ringing string again, at a fraction of its length [N].
    bool note_on(double force, double place = 0.5) {
        jvari::Scene plucked = scene_;
        plucked.strings[0].pluck =
            jvari::Pluck{.amplitude = -force,
                         .duration = 10e-3,
                         .skew = 30,
                         .position = place * plucked.strings[0].length};
        return go_on(plucked);
    }
    // Tunes the ringing string [N]. A body keeps the tuning of the scene.
    bool set_tension(double tension) {
        scene_.strings[0].tension = tension;
        return go_on(scene_);
    }
    // What an audio callback does: nothing is allocated. False: the scheme failed.
    bool process(double* force) noexcept {
        const jvari::Block block{.rows = rows, .taps = 1, .stride = rows, .tap = force};
        return sounding_->advance(block).outcome == jvari::Outcome::ok;
    }

private:
    static std::unique_ptr<jvari::Scheme> made(const jvari::Scene& scene) {
        const auto all = jvari::schemes();
        const auto found = std::find_if(all.begin(), all.end(), [](const jvari::Descriptor& d) {
            return d.name == std::string(${cpp_word(scheme)});
        });
        const jvari::Settings settings{.sample_rate = ${rate},
                                       .tap_rate = ${rate},
                                       .modes = ${modes},
                                       .options = {${pairs}}};
        return jvari::make_scheme(*found, scene, settings);
    }
    // Makes a scheme, which allocates: call it outside of the callback, between two blocks. False
    // where the scheme cannot go on from another.
    bool go_on(const jvari::Scene& scene) {
        auto next = made(scene);
        if (!next->start_from(*sounding_)) return false;
        sounding_ = std::move(next);
        return true;
    }

    jvari::Scene scene_;
    std::unique_ptr<jvari::Scheme> sounding_;
};

int main() {  // 0.5 s, plucked again, and 0.5 s a semitone higher
    Voice voice;
    const jvari::FlushDenormals flush;
    std::vector<double> block(Voice::rows);
    const double higher = string().strings[0].tension * std::pow(2, 2 / 12.0);
    for (int part = 0; part < 2; ++part) {
        double most = 0;
        for (int n = 0; n < ${rate} / 2 / Voice::rows; ++n) {
            if (!voice.process(block.data())) return 1;
            for (const double x : block) most = std::max(most, std::abs(x));
        }
        std::printf("largest value in half a second: %g\\n", most);
        if (part == 0 && !(voice.set_tension(higher) && voice.note_on(0.4)))
            std::puts("this scheme cannot go on from another");
    }
}
`;
  },
  Python({about, text, overrides, scheme, rate, modes, options}) {
    const pairs = options.map(o => o.split("=").map(cpp_word).join(": ")).join(", "),
      sets = overrides.map(o => {
        const [key, value] = o.split(/=(.*)/s);
        return `    scene = scene.set(${cpp_word(key)}, ${Number.isFinite(Number(value)) ? value : cpp_word(value)})`;
      });
    return `${wrapped(about, "#")}
import pathlib

import jvari

SCENE = r'''
${text.replaceAll("'''", "' ' '").replace(/\n*$/, "\n")}'''


def string(**changes):
    """The scene; changes: tension=35 [N] and other keys of its first string."""
    path = pathlib.Path("taken_scene.toml")
    path.write_text(SCENE, encoding="utf-8")
    scene = jvari.scene(path)
${sets.map(line => line + "\n").join("")}    for key, value in changes.items():
        scene = scene.set(f"string.0.{key}", value)
    return scene


def play(seconds, **changes):
    """A run; run[tap] is an array with a row every 1/${rate} s."""
    return jvari.run(string(**changes).set("duration", seconds), ${cpp_word(scheme)},
                     rate=${rate}, tap_rate=${rate}, modes=${modes},
                     options={${pairs}})


if __name__ == "__main__":
    run = play(1.0)
    for tap in run.keys():
        print(f"{tap}: largest value {abs(run[tap]).max():g} {run.units[tap]}")
`;
  },
};

function show_take() {
  if (!by_id("take_part").open || !shown.scene || !shown.motion) return;
  const {motion, words, scene} = shown,
    files = Object.keys(state.files).join(", "),
    about = [by_id("title").textContent, words && heard_words(words)].filter(Boolean).join(". "),
    tap = scene.tap.findIndex(t => t.quantity === "nut_force"),
    string = {
      ...run_of({modes: motion.modes}),
      about: `${scene.name}: ${about}${files && ` It reads ${files} from the working directory.`}`,
      text: scene_text(),
      tap: Math.max(0, tap),
    },
    chosen = by_id("take_choice").value;
  by_id("take_text").textContent = taken[chosen](string);
}
