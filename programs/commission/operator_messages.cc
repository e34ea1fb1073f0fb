// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/commission/operator_messages.hh"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include <fmt/format.h>

namespace mw::programs {

using commissioning::Act;
using commissioning::Ask;
using commissioning::Fault;
using commissioning::Finding;
using commissioning::Guide;
using commissioning::Prompt;

namespace {

using Json = nlohmann::ordered_json;

constexpr int COMPACT = -1;
constexpr bool IS_ASCII = false, HAS_EXCEPTIONS = false;

Json prompt_json(const Prompt &prompt) {
    return {
        {"step", prompt.step},       {"motor", prompt.motor},     {"ask", ask_name(prompt.ask)},
        {"text", prompt.text},       {"choices", prompt.choices}, {"unit", prompt.unit},
        {"hazards", prompt.hazards}, {"watch", prompt.watch},     {"may_end_early", prompt.may_end_early}};
}

Json step_json(const commissioning::Step &step, const std::optional<Finding> &finding) {
    Json json{{"name", step.name}, {"title", step.title}, {"state", "due"}};
    if (!finding.has_value()) {
        return json;
    }
    json["state"] = finding->fault == Fault::NONE ? "passed" : "fault";
    json["fault"] = finding->fault == Fault::NONE ? "" : std::string(fault_name(finding->fault));
    json["remedy"] = std::string(fault_remedy(finding->fault));
    json["detail"] = finding->detail;
    Json values = Json::array();
    for (const commissioning::Value &value : finding->values) {
        values.push_back({{"name", value.name}, {"number", value.number}, {"unit", value.unit}});
    }
    json["values"] = std::move(values);
    return json;
}

const char *state_name(const Guide &guide, const std::string &error) {
    return !error.empty()      ? "error"
           : guide.isFaulted() ? "fault"
           : guide.isReady()   ? "ready"
           : guide.isOver()    ? "done"
                               : "running";
}

std::optional<Act::Type> type_of(const std::string &name) {
    if (name == "confirm") {
        return Act::Type::CONFIRM;
    }
    if (name == "hold") {
        return Act::Type::HOLD;
    }
    if (name == "release") {
        return Act::Type::RELEASE;
    }
    if (name == "number") {
        return Act::Type::NUMBER;
    }
    if (name == "choice") {
        return Act::Type::CHOICE;
    }
    if (name == "cannot") {
        return Act::Type::CANNOT;
    }
    return std::nullopt;
}

}  // namespace

std::string state_message(const Guide &guide, const std::string &error) {
    Json steps = Json::array();
    for (std::size_t i = 0; i < guide.steps().size(); ++i) {
        steps.push_back(step_json(guide.steps()[i], guide.findings()[i]));
    }
    const Json json{{"state", state_name(guide, error)}, {"error", error},
                    {"number", guide.prompt_number()},   {"prompt", prompt_json(guide.prompt())},
                    {"current", guide.current()},        {"steps", std::move(steps)}};
    return json.dump(COMPACT, ' ', IS_ASCII, Json::error_handler_t::replace);
}

std::optional<NumberedAct> read_act(std::string_view line) {
    const auto isFlat = [](int depth, Json::parse_event_t, Json &) { return depth < 2; };
    const Json json = Json::parse(line, isFlat, HAS_EXCEPTIONS);
    if (!json.is_object() || !json.contains("number") || !json["number"].is_number_integer() ||
        !json.contains("act") || !json["act"].is_string()) {
        return std::nullopt;
    }
    const auto type = type_of(json["act"].get<std::string>());
    const bool has_value = json.contains("value") && json["value"].is_number();
    const bool has_choice = json.contains("choice") && json["choice"].is_string();
    if (!type.has_value() || (type == Act::Type::NUMBER && !has_value) ||
        (type == Act::Type::CHOICE && !has_choice)) {
        return std::nullopt;
    }
    NumberedAct act{json["number"].get<int>(), {*type, 0, ""}};
    act.act.number = has_value ? json["value"].get<double>() : 0;
    act.act.choice = has_choice ? json["choice"].get<std::string>() : "";
    return act;
}

OperatorMessages::OperatorMessages() {
    const int states = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    output_ = states >= 0 ? ::fdopen(states, "w") : nullptr;
    if (output_ != nullptr) {
        std::fflush(stdout);
        static_cast<void>(::dup2(STDERR_FILENO, STDOUT_FILENO));
    }
}

OperatorMessages::~OperatorMessages() {
    if (output_ != nullptr) {
        static_cast<void>(std::fclose(output_));
    }
}

void OperatorMessages::print(const std::string &line) {
    std::FILE *const output = output_ != nullptr ? output_ : stdout;
    fmt::print(output, "{}\n", line);
    std::fflush(output);
}

bool OperatorMessages::look(Guide &guide, double) {
    if (guide.prompt_number() != shown_number_ || guide.current() != shown_current_) {
        shown_number_ = guide.prompt_number();
        shown_current_ = guide.current();
        print(state_message(guide, ""));
    }
    const bool is_there = read_standard_input(input_);
    for (std::size_t end = input_.find('\n'); end != std::string::npos; end = input_.find('\n')) {
        if (const auto act = read_act(std::string_view(input_).substr(0, end))) {
            static_cast<void>(guide.act(act->prompt_number, act->act));
        }
        input_.erase(0, end + 1);
    }
    return is_there;
}

void OperatorMessages::show_failure(const std::string &error) {
    print(Json{{"state", "error"}, {"error", error}}.dump(COMPACT, ' ', IS_ASCII,
                                                          Json::error_handler_t::replace));
}

void OperatorMessages::show_end(const Guide &guide, const std::string &error) {
    print(state_message(guide, error));
}

}  // namespace mw::programs
