// Certificates as files. <scene>.json holds what repeats to the last digit on one program and one
// type of machine; <scene>.cost.json beside it what a clock measured, with date, commit and
// machine: numbers of the two kinds never share a file that is committed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "bench/store/machine.hpp"
#include "reference/certificate.hpp"

namespace jvari::bench::trust {

struct KeptCertificate {
    std::string key;         // of the scene, the settings, what was to be run, and the program
    std::string scene_hash;  // of the scene whatever its duration
    Certificate certificate;
    std::string program = store::run_identity();  // that made it
};

std::string timeless_hash(const Scene&);  // scene_hash of the scene as if it lasted 1 s
// Key, hash, program, and the entries without their outcome; throws Refusal.
KeptCertificate planned_certificate(const Scene&, const CertifySettings&,
                                    const std::string& program = store::run_identity());
// the same sources, compiler, flags and vector instructions
bool of_this_program(const KeptCertificate&);

std::string json_of(const KeptCertificate&);  // with a checksum over all the rest
// wall seconds of each entry, and what they were measured with
std::string cost_json_of(const KeptCertificate&);

// Nothing, and `why`, where there is no such file, it is not whole, or it is of another format. One
// that another program made is read: its figures are those of the references as they were then.
std::optional<KeptCertificate> read_certificate(const std::filesystem::path&, std::string& why);

std::filesystem::path cost_path(const std::filesystem::path& certificate);  // a.json: a.cost.json
// Fills in the wall seconds from the file beside the certificate; they stay NaN where that is not
// of the same key.
void read_costs(const std::filesystem::path& certificate, KeptCertificate&);

}  // namespace jvari::bench::trust
