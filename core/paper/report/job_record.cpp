#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/input_error.h"
#include "base/io/output.h"
#include "base/text_hash.h"
#include "paper/report/job.h"

namespace stopline {

namespace {

constexpr const char* kRecord = "job.json";

std::vector<std::string> files_of(const JobOutput& output) {
    std::vector<std::string> files;
    for (const std::string& figure : output.figures) {
        files.push_back(figure + ".svg");
        files.push_back(figure + ".png");
    }
    files.insert(files.end(), output.tables.begin(), output.tables.end());
    for (const std::string& experiment : output.measured) files.push_back(measured_file("", experiment).string());
    return files;
}

// Returns the hash of a record without its entry "checksum".
std::string checksum_of(nlohmann::ordered_json json) {
    json.erase("checksum");
    return fmt::format("{:016x}", hash_of(json.dump()));
}

std::string hash_text(const std::filesystem::path& file) { return fmt::format("{:016x}", hash_of(read_file(file))); }

}  // namespace

std::filesystem::path measured_file(const std::filesystem::path& folder, const std::string& experiment) {
    return folder / ("measured_" + experiment + ".csv");
}

void store_record(const std::filesystem::path& folder, const std::string& key, const JobOutput& output) {
    nlohmann::ordered_json json;
    json["key"] = key;
    json["figures"] = output.figures;
    json["tables"] = output.tables;
    json["measured"] = output.measured;
    json["conditions"] = output.conditions;
    json["commands"] = output.commands;
    json["seeds"] = output.seeds;
    json["scenario_hashes"] = output.scenario_hashes;
    json["violations"] = output.violations;
    json["files"] = nlohmann::ordered_json::object();
    for (const std::string& file : files_of(output)) json["files"][file] = hash_text(folder / file);
    json["checksum"] = checksum_of(json);
    write_file(folder / kRecord, json.dump(2) + "\n");
}

std::optional<JobOutput> load_record(const std::filesystem::path& folder, const std::string& key) {
    if (!std::filesystem::exists(folder / kRecord)) return std::nullopt;
    try {
        const nlohmann::ordered_json json = nlohmann::ordered_json::parse(read_file(folder / kRecord));
        if (json.at("key") != key || json.at("checksum") != checksum_of(json)) return std::nullopt;
        JobOutput output;
        json.at("figures").get_to(output.figures);
        json.at("tables").get_to(output.tables);
        json.at("measured").get_to(output.measured);
        json.at("conditions").get_to(output.conditions);
        json.at("commands").get_to(output.commands);
        json.at("seeds").get_to(output.seeds);
        json.at("scenario_hashes").get_to(output.scenario_hashes);
        json.at("violations").get_to(output.violations);
        const nlohmann::ordered_json& hashes = json.at("files");
        const std::vector<std::string> files = files_of(output);
        const bool same = std::all_of(files.begin(), files.end(), [&](const std::string& file) {
            return std::filesystem::is_regular_file(folder / file) && hashes.at(file) == hash_text(folder / file);
        });
        if (!same) return std::nullopt;
        return output;
    } catch (const nlohmann::json::exception&) {
        return std::nullopt;  // damaged record: the job is repeated
    } catch (const InputError&) {
        return std::nullopt;
    }
}

}  // namespace stopline
