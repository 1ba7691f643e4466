// Certificates as files. <scene>.json holds what repeats to the last digit on one program and one type of machine; <scene>.cost.json beside
// it what a clock measured, with date, commit and machine: numbers of the two kinds never share a file that is committed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "reference/certificate.hpp"

namespace jvari::bench::trust {

struct KeptCertificate {
    std::string key;         // of the scene, the program's version, the settings and what was to be run
    std::string scene_hash;  // of the scene whatever its duration
    Certificate certificate;
};

std::string timeless_hash(const Scene&);  // scene_hash of the scene as if it lasted 1 s
KeptCertificate planned_certificate(const Scene&,
                                    const CertifySettings&);  // key, hash, and the entries without their outcome; throws Refusal

std::string json_of(const KeptCertificate&);       // with a checksum over all the rest
std::string cost_json_of(const KeptCertificate&);  // wall seconds of each entry, and what they were measured with

// Nothing, and `why`, where there is no such file, it is not whole, or it is of another version of the program.
std::optional<KeptCertificate> read_certificate(const std::filesystem::path&, std::string& why);

std::filesystem::path cost_path(const std::filesystem::path& certificate);  // a.json: a.cost.json
// Fills in the wall seconds from the file beside the certificate; they stay NaN where that is not of the same key.
void read_costs(const std::filesystem::path& certificate, KeptCertificate&);

}  // namespace jvari::bench::trust
