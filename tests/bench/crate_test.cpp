// ro-crate-metadata.json: what RO-Crate 1.1 asks of every crate, in a folder that was just written and in those that are committed.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "bench/report/crate.hpp"
#include "bench/store/fresh_file.hpp"
#include "tests/command_line.hpp"

namespace jvari::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// The entity of an id; the test fails where there is none, or more than one.
Json entity(const Json& crate, const std::string& id) {
    Json found;
    for (const Json& e : crate.at("@graph"))
        if (e.at("@id") == id) {
            EXPECT_TRUE(found.is_null()) << "two entities " << id;
            found = e;
        }
    EXPECT_FALSE(found.is_null()) << "no entity " << id;
    return found;
}

void must_be_valid(const fs::path& folder) {
    const Json crate = Json::parse(bench::store::read_whole(folder / bench::report::crate_file));
    EXPECT_EQ(crate.at("@context"), "https://w3id.org/ro/crate/1.1/context");
    const Json descriptor = entity(crate, bench::report::crate_file), root = entity(crate, "./");
    EXPECT_EQ(descriptor.at("@type"), "CreativeWork");
    EXPECT_EQ(descriptor.at("about").at("@id"), "./");
    EXPECT_EQ(descriptor.at("conformsTo").at("@id"), "https://w3id.org/ro/crate/1.1");
    EXPECT_EQ(root.at("@type"), "Dataset");
    for (const char* key : {"name", "description"}) EXPECT_FALSE(root.at(key).get<std::string>().empty()) << key;
    EXPECT_EQ(root.at("datePublished").get<std::string>().find("20"), 0u) << "an ISO 8601 date";
    EXPECT_EQ(root.at("license").at("@id"), "https://spdx.org/licenses/MIT");  // CITATION.cff
    entity(crate, root.at("license").at("@id"));
    ASSERT_FALSE(root.at("author").empty());
    for (const Json& author : root.at("author")) EXPECT_FALSE(entity(crate, author.at("@id")).at("name").get<std::string>().empty());
    ASSERT_FALSE(root.at("hasPart").empty());
    for (const Json& part : root.at("hasPart")) {
        const std::string id = part.at("@id");
        EXPECT_EQ(entity(crate, id).at("@type"), id.ends_with('/') ? "Dataset" : "File");
        EXPECT_TRUE(fs::exists(folder / id)) << folder << " lacks " << id;
    }
}

TEST(Crate, OfAComparisonIsValidAndNamesItsParts) {
    const Scratch scratch;
    const auto ran = jvari(
        scratch, "compare free_string --duration 0.01 --rates 44100 --schemes modal_two_point --repeats 1 --out " + (scratch / "out"));
    ASSERT_EQ(ran.code, 0) << ran.err;
    must_be_valid(scratch / "out");
    const Json root = entity(Json::parse(content(scratch / "out/ro-crate-metadata.json")), "./");
    EXPECT_EQ(root.at("name"), "jvari results: free_string");
    for (const char* part : {"errors.csv", "manifest.json", "report.html", "cells/"})
        EXPECT_NE(root.at("hasPart").dump().find('"' + std::string(part) + '"'), std::string::npos) << part;
}

TEST(Crate, EachCommittedFolderOfResultsHasOne) {
    int folders = 0;
    for (const auto& entry : fs::recursive_directory_iterator(JVARI_RESULTS)) {
        if (entry.path().filename() != "manifest.json" || entry.path().string().find("/runs/") != std::string::npos) continue;
        must_be_valid(entry.path().parent_path());
        ++folders;
    }
    EXPECT_GE(folders, 20);
}

TEST(Crate, NeedsAManifest) {
    const Scratch scratch;
    const auto ran = jvari(scratch, "report " + scratch.path.string() + " --crate");
    EXPECT_TRUE(ends(ran, 2, "manifest.json"));
}

}  // namespace
}  // namespace jvari::test
