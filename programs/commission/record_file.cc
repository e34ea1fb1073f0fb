// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/commission/record_file.hh"

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/atomic_file.hh"

namespace mw::programs {
namespace {

using commissioning::Fault;
using commissioning::Finding;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

std::string path_of(const std::string &folder) {
    return (fs::path(folder) / RECORD_FILE).string();
}

/// Endings of the keys of a motor that determine its travel.
constexpr std::array GEOMETRY{".steps_per_turn", ".microsteps",      ".transmission",    ".way_per_turn",
                              ".pitch",          ".teeth",           ".belt_pitch",      ".module",
                              ".gear",           ".reverse",         ".counts_per_turn", ".channel",
                              ".reverse_output", ".reverse_encoder", ".step_pin",        ".dir_pin"};
constexpr std::array GENERAL{"board", "drives", "kind", "units"};

/// True if a step depends on an answer. A finding with a simulated board is not valid for a real one.
bool dependsOn(const Finding &finding, std::string_view key) {
    const std::string_view step = finding.step;
    if (key == "board.simulated") {
        return true;
    }
    if (std::ranges::find(GENERAL, key) != GENERAL.end()) {
        return step != "thread";
    }
    if (finding.motor.empty()) {
        return (step == "inputs" &&
                (key.ends_with(".home_pin") || key.ends_with(".home_contact") || key == "switch.contacts")) ||
               (step == "estop" && key == "pin.estop") ||
               (step == "probe" && (key == "pin.probe" || key == "probe.contacts")) ||
               (step == "spindle" && (key.starts_with("spindle.") || key.starts_with("pin.spindle")));
    }
    if (!key.starts_with(finding.motor + ".")) {
        return false;
    }
    const std::string_view end = key.substr(finding.motor.size());
    const bool is_switch = end == ".home_pin" || end == ".home_contact" || end == ".home";
    return std::ranges::find(GEOMETRY, end) != GEOMETRY.end() ||
           (end == ".correction" && step != "direction") || (step == "home" && is_switch) ||
           (step == "backlash" && end == ".backlash") ||
           (step == "travel" && (is_switch || end == ".min" || end == ".max")) ||
           (step == "limits" && (end == ".speed" || end == ".acceleration")) ||
           (step == "tune" && (end == ".p" || end == ".ff1" || end == ".ff2" || end == ".full_speed"));
}

setup::Answers basis_of(const Finding &finding, const setup::Answers &answers) {
    setup::Answers basis;
    for (const setup::Question &question : setup::questions(answers)) {
        if (dependsOn(finding, question.key)) {
            basis[question.key] = setup::answer_of({question}, answers, question.key);
        }
    }
    return basis;
}

Json json_of(const setup::Answers &answers) {
    Json json = Json::object();
    for (const auto &[key, value] : answers) {
        json[key] = value;
    }
    return json;
}

setup::Answers answers_in(const Json &json, const char *key) {
    setup::Answers answers;
    const auto found = json.find(key);
    if (found != json.end() && found->is_object()) {
        for (const auto &[name, value] : found->items()) {
            if (value.is_string()) {
                answers[name] = value.get<std::string>();
            }
        }
    }
    return answers;
}

Json json_of(const Recorded &recorded) {
    const Finding &finding = recorded.finding;
    Json values = Json::array();
    for (const commissioning::Value &value : finding.values) {
        values.push_back({{"name", value.name}, {"number", value.number}, {"unit", value.unit}});
    }
    return {{"step", finding.step},
            {"motor", finding.motor},
            {"title", recorded.title},
            {"fault", std::string(commissioning::fault_name(finding.fault))},
            {"detail", finding.detail},
            {"values", std::move(values)},
            {"changed", json_of(finding.after)},
            {"answers", json_of(recorded.basis)},
            {"date", recorded.date},
            {"version", recorded.version}};
}

std::string text_of(const Json &json, const char *key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

Fault fault_of(const std::string &name) {
    for (int i = 0; i <= static_cast<int>(Fault::STOPPED); ++i) {
        if (commissioning::fault_name(static_cast<Fault>(i)) == name) {
            return static_cast<Fault>(i);
        }
    }
    return Fault::GIVEN_UP;
}

Recorded recorded_of(const Json &json) {
    Recorded recorded;
    recorded.title = text_of(json, "title");
    recorded.date = text_of(json, "date");
    recorded.version = text_of(json, "version");
    Finding &finding = recorded.finding;
    finding.step = text_of(json, "step");
    finding.motor = text_of(json, "motor");
    finding.fault = fault_of(text_of(json, "fault"));
    finding.detail = text_of(json, "detail");
    if (const auto values = json.find("values"); values != json.end() && values->is_array()) {
        for (const Json &value : *values) {
            const auto number = value.is_object() ? value.find("number") : value.end();
            const bool is_number = value.is_object() && number != value.end() && number->is_number();
            finding.values.push_back(
                {text_of(value, "name"), is_number ? number->get<double>() : 0, text_of(value, "unit")});
        }
    }
    finding.after = answers_in(json, "changed");
    recorded.basis = answers_in(json, "answers");
    return recorded;
}

}  // namespace

Result<std::vector<Recorded>> read_record(const std::string &folder) {
    std::error_code error;
    if (!fs::exists(path_of(folder), error)) {
        return std::vector<Recorded>{};
    }
    const auto text = read_file(path_of(folder));
    if (!text.has_value()) {
        return std::unexpected(text.error());
    }
    const Json json = Json::parse(*text, nullptr, false);
    const auto steps = json.is_object() ? json.find("steps") : json.end();
    if (!json.is_object() || steps == json.end() || !steps->is_array()) {
        return fail("the record of commissioning cannot be read", {path_of(folder), 0, 0},
                    "move the file to another folder to start again");
    }
    std::vector<Recorded> record;
    for (const Json &step : *steps) {
        if (step.is_object()) {
            record.push_back(recorded_of(step));
        }
    }
    return record;
}

bool isValid(const Recorded &recorded, const setup::Answers &answers) {
    const auto asked = setup::questions(answers);
    return std::ranges::all_of(recorded.basis, [&](const auto &answer) {
        return setup::answer_of(asked, answers, answer.first) == answer.second;
    });
}

std::vector<Finding> valid_findings(const std::vector<Recorded> &record, const setup::Answers &answers) {
    std::vector<Finding> valid;
    for (const Recorded &recorded : record) {
        if (recorded.finding.fault == Fault::NONE && isValid(recorded, answers)) {
            valid.push_back(recorded.finding);
        }
    }
    return valid;
}

Result<> write_record(const std::string &folder, const commissioning::Guide &guide, const std::string &date,
                      const std::string &version) {
    auto record = read_record(folder);
    if (!record.has_value()) {
        return std::unexpected(record.error());
    }
    Json steps = Json::array();
    for (std::size_t i = 0; i < guide.steps().size(); ++i) {
        const auto &found = guide.findings()[i];
        const std::string &title = guide.steps()[i].title;
        const auto old = std::ranges::find(*record, title, &Recorded::title);
        if (!found.has_value()) {
            if (old != record->end()) {
                steps.push_back(json_of(*old));
            }
            continue;
        }
        // A finding of an earlier session keeps its date.
        const bool is_old =
            old != record->end() && old->finding.fault == found->fault &&
            old->finding.after == found->after &&
            std::ranges::equal(old->finding.values, found->values, [](const auto &a, const auto &b) {
                return a.name == b.name && a.number == b.number;
            });
        Recorded fresh{*found, {}, title, date, version};
        fresh = is_old ? *old : fresh;
        fresh.basis = basis_of(*found, guide.answers());
        steps.push_back(json_of(fresh));
    }
    const Json json{{"ready", guide.isReady()}, {"steps", std::move(steps)}};
    constexpr int INDENT = 1;
    return write_file_atomically(path_of(folder),
                                 json.dump(INDENT, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace mw::programs
