// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/hal/hal_service.hh"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "clients/screen/http/error_response.hh"
#include "messages/declarations/json_parse.hh"

namespace mw::screen {
namespace {

using Json = nlohmann::ordered_json;
using hal::view::CaptureRequest;
using hal::view::CaptureState;
using hal::view::TriggerKind;

constexpr std::array<std::pair<TriggerKind, const char *>, 6> TRIGGERS{{{TriggerKind::NONE, "NONE"},
                                                                        {TriggerKind::ABOVE, "ABOVE"},
                                                                        {TriggerKind::BELOW, "BELOW"},
                                                                        {TriggerKind::RISING, "RISING"},
                                                                        {TriggerKind::FALLING, "FALLING"},
                                                                        {TriggerKind::EITHER, "EITHER"}}};

Json json_of(const hal::Value &value) {
    switch (value.type) {
    case hal::Type::BIT: return value.as_bit();
    case hal::Type::FLOAT: return value.as_float();  // null if it is not finite
    case hal::Type::S32: return value.as_s32();
    case hal::Type::U32:
    case hal::Type::PORT: return value.as_u32();
    case hal::Type::S64: return value.as_s64();
    case hal::Type::U64: return value.as_u64();
    }
    return nullptr;
}

/// Maximum number of pulses, because readers of HAL wait for them.
constexpr std::uint32_t MOST_PULSE_MS = 500;

std::string text_of(const Json &json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Response document(const Json &json) {
    Response response;
    response.body = text_of(json);
    return response;
}

Json pin_document(const hal::PinInfo &pin) {
    return {{"name", pin.name},
            {"type", hal::type_name(pin.type)},
            {"dir", hal::dir_name(pin.dir)},
            {"owner", pin.owner},
            {"signal", pin.signal},
            {"value", json_of(pin.value)}};
}

Json param_document(const hal::ParamInfo &param) {
    return {{"name", param.name},
            {"type", hal::type_name(param.type)},
            {"dir", hal::dir_name(param.dir)},
            {"owner", param.owner},
            {"value", json_of(param.value)}};
}

Json signal_document(const hal::SignalInfo &signal) {
    Json pins = Json::array();
    for (const hal::SignalPin &pin : signal.pins) {
        pins.push_back({{"name", pin.name}, {"dir", hal::dir_name(pin.dir)}});
    }
    return {{"name", signal.name},
            {"type", hal::type_name(signal.type)},
            {"writers", signal.writers},
            {"pins", std::move(pins)},
            {"value", json_of(signal.value)}};
}

/// A member of this type; `preset` if it is missing, nothing if it has another type.
template <class T>
std::optional<T> member(const Json &json, const char *name, T preset) {
    const auto found = json.find(name);
    if (found == json.end()) {
        return preset;
    }
    if constexpr (std::is_same_v<T, std::string>) {
        return found->is_string() ? std::optional(found->get<T>()) : std::nullopt;
    } else if constexpr (std::is_same_v<T, double>) {
        return found->is_number() ? std::optional(found->get<T>()) : std::nullopt;
    } else {
        const bool fits = found->is_number_unsigned() && found->get<std::uint64_t>() <= UINT32_MAX;
        return fits ? std::optional(found->get<T>()) : std::nullopt;
    }
}

std::optional<std::vector<std::string>> names_of(const Json &json) {
    const auto names = json.find("names");
    if (names == json.end() || !names->is_array()) {
        return std::nullopt;
    }
    std::vector<std::string> all;
    for (const Json &name : *names) {
        if (!name.is_string()) {
            return std::nullopt;
        }
        all.push_back(name.get<std::string>());
    }
    return all;
}

Result<CaptureRequest> request_of(const Json &json) {
    if (!json.is_object()) {
        return fail("this is no JSON object");
    }
    const auto names = names_of(json);
    const auto samples = member<std::uint32_t>(json, "samples", 1000),
               every = member<std::uint32_t>(json, "every", 1);
    const auto trigger = member<std::string>(json, "trigger", "NONE");
    const auto trigger_name = member<std::string>(json, "trigger_name", "");
    const auto level = member<double>(json, "level", 0.5),
               pretrigger = member<double>(json, "pretrigger", 0.0);
    const bool whole = names.has_value() && samples.has_value() && every.has_value() && trigger.has_value() &&
                       trigger_name.has_value() && level.has_value() && pretrigger.has_value();
    if (!whole) {
        return fail(
            "a record wants names, samples, every, trigger, trigger_name, level, pretrigger in their types");
    }
    const auto *const found = std::find_if(TRIGGERS.begin(), TRIGGERS.end(),
                                           [&](const auto &one) { return *trigger == one.second; });
    if (found == TRIGGERS.end()) {
        return fail("the trigger is NONE, ABOVE, BELOW, RISING, FALLING or EITHER");
    }
    if (*samples > HalService::MOST_SAMPLES) {
        return fail("a screen is shown at most " + std::to_string(HalService::MOST_SAMPLES) + " samples");
    }
    return CaptureRequest{*names, *samples, *every, found->first, *trigger_name, *level, *pretrigger};
}

const char *state_name(CaptureState state) {
    switch (state) {
    case CaptureState::IDLE: return "IDLE";
    case CaptureState::FILLING: return "FILLING";
    case CaptureState::WAITING: return "WAITING";
    case CaptureState::TRIGGERED: return "TRIGGERED";
    case CaptureState::DONE: return "DONE";
    case CaptureState::REFUSED: return "REFUSED";
    }
    return "";
}

}  // namespace

hal::Host *HalService::host() {
    if (host_ != nullptr && host_->hal().host_status().end_reason().has_value()) {
        capture_.reset();
        dialogs_.leave();
        has_told_failure_ = false;
        host_.reset();
    }
    if (host_ == nullptr) {
        auto joined = connect_();
        if (!joined.has_value()) {
            reason_ = joined.error().str();
            return nullptr;
        }
        host_ = std::move(*joined);
    }
    return host_.get();
}

Response HalService::list(const std::string &glob) {
    hal::Host *const joined = host();
    if (joined == nullptr) {
        return error_response(503, reason_);
    }
    hal::Instance &hal = joined->hal();
    Json json{{"pins", Json::array()}, {"signals", Json::array()}, {"params", Json::array()}};
    for (const hal::PinInfo &pin : hal.pins().list(glob)) {
        json["pins"].push_back(pin_document(pin));
    }
    for (const hal::SignalInfo &signal : hal.signals().list(glob)) {
        json["signals"].push_back(signal_document(signal));
    }
    for (const hal::ParamInfo &param : hal.params().list(glob)) {
        json["params"].push_back(param_document(param));
    }
    return document(json);
}

Response HalService::inputs() {
    hal::Host *const joined = host();
    if (joined == nullptr) {
        return error_response(503, reason_);
    }
    hal::Instance &hal = joined->hal();
    std::set<std::string> written;
    for (const hal::SignalInfo &signal : hal.signals().list("*")) {
        if (signal.writers > 0) {
            written.insert(signal.name);
        }
    }
    const auto hasSource = [&](const std::string &name) {
        const auto pins = hal.pins().list(name);
        return std::ranges::any_of(pins,
                                   [&](const hal::PinInfo &pin) { return written.contains(pin.signal); });
    };
    Json spindles = Json::array();
    for (int i = 0; hal.pins().has(fmt::format("spindle.{}.speed-in", i)); ++i) {
        spindles.push_back({{"speed_in", hasSource(fmt::format("spindle.{}.speed-in", i))},
                            {"at_speed", hasSource(fmt::format("spindle.{}.at-speed", i))}});
    }
    return document({{"probe", hasSource("motion.probe-input")}, {"spindles", std::move(spindles)}});
}

Response HalService::set(const std::string &name, std::string_view body) {
    hal::Host *const joined = host();
    if (joined == nullptr) {
        return error_response(503, reason_);
    }
    const Json json = messages::parse_json(body);
    const auto value = json.is_object() ? member<std::string>(json, "value", "") : std::nullopt;
    if (!value.has_value() || value->empty()) {
        return error_response(400, R"(a value is set by {"value": "..."})");
    }
    hal::Instance &hal = joined->hal();
    const bool is_signal = !hal.params().has(name) && !hal.pins().has(name) && hal.signals().has(name);
    const auto put = [&](const std::string &text) {
        return is_signal ? hal.signals().set(name, text) : hal.values().set(name, text);
    };
    const auto pulse_ms = member<std::uint32_t>(json, "pulse_ms", 0);
    const auto before = is_signal ? hal.signals().get(name) : hal.values().get(name);
    if (!pulse_ms.has_value() || *pulse_ms > MOST_PULSE_MS) {
        return error_response(400, "a pulse is at most " + std::to_string(MOST_PULSE_MS) + " ms long");
    }
    auto done = put(*value);
    if (done.has_value() && *pulse_ms > 0 && before.has_value()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(*pulse_ms));
        done = put(before->str());
    }
    return done.has_value() ? document(Json::object()) : error_response(400, done.error().str());
}

std::map<std::string, std::string> HalService::read(const std::vector<std::string> &names) {
    std::map<std::string, std::string> values;
    hal::Host *const joined = host();
    for (const std::string &name : names) {
        std::string &text = values[name] = "null";
        if (joined == nullptr) {
            continue;
        }
        auto value = joined->hal().values().get(name);
        if (!value.has_value()) {
            value = joined->hal().signals().get(name);
        }
        if (value.has_value()) {
            text = text_of(json_of(*value));
        }
    }
    return values;
}

void HalService::look_at_dialogs(News &news) {
    hal::Host *const joined = dialogs_.facts().empty() ? nullptr : host();
    if (joined != nullptr && !dialogs_.isReady() && !has_told_failure_) {
        const auto begun = dialogs_.begin(joined->hal());
        if (!begun.has_value()) {
            has_told_failure_ = true;
            news.notes.push_back("[DISPLAY]MESSAGE_PINNAME: " + begun.error().str());
        }
    }
    Json questions = Json::array();
    for (const std::size_t place : dialogs_.look()) {
        const DialogFacts &one = dialogs_.facts()[place];
        const char *const kind = one.kind.isYesNo ? "yesno" : one.kind.isOk ? "ok" : "none";
        questions.push_back({{"id", one.id},
                             {"number", one.number},
                             {"kind", kind},
                             {"title", one.title},
                             {"text", one.text},
                             {"details", one.details},
                             {"icon", one.icon}});
    }
    news.questions = text_of(questions);
    for (std::string &note : dialogs_.take_notes()) {
        news.notes.push_back(std::move(note));
    }
}

HalService::News HalService::look(const std::vector<std::string> &names) {
    News news;
    if (!names.empty()) {
        news.values = read(names);
    }
    look_at_dialogs(news);
    if (begin_ != nullptr && host() != nullptr) {
        for (std::string &note : std::exchange(begin_, nullptr)()) {
            news.notes.push_back(std::move(note));
        }
    }
    news.has_begun = begin_ == nullptr;
    return news;
}

Response HalService::answer(std::string_view body) {
    const Json json = messages::parse_json(body);
    const bool isObject = json.is_object() && json.contains("yes") && json["yes"].is_boolean();
    const auto id = isObject ? member<std::string>(json, "id", "") : std::nullopt;
    const auto number = isObject ? member<std::uint32_t>(json, "number", 0) : std::nullopt;
    if (!id.has_value() || !number.has_value()) {
        return error_response(400, R"(an answer is {"id": "...", "number": 0, "yes": true})");
    }
    const bool taken = dialogs_.answer(*id, static_cast<std::int32_t>(*number), json["yes"].get<bool>());
    return taken ? document(Json::object()) : error_response(409, "this is asked no more");
}

Response HalService::state() const {
    return document(Json{{"state", capture_.has_value() ? state_name(capture_->state()) : "CLOSED"}});
}

Response HalService::begin(std::string_view body) {
    hal::Host *const joined = host();
    if (joined == nullptr) {
        return error_response(503, reason_);
    }
    const Json json = messages::parse_json(body);
    const auto request = request_of(json);
    if (!request.has_value()) {
        return error_response(400, request.error().str());
    }
    const auto thread = member<std::string>(json, "thread", "");
    if (!thread.has_value()) {
        return error_response(400, "the thread is a text");
    }
    if (capture_.has_value() && thread_ != *thread) {
        capture_.reset();
    }
    if (!capture_.has_value()) {
        auto opened = hal::view::Capture::open(*joined, *thread);
        if (!opened.has_value()) {
            return error_response(409, opened.error().str());
        }
        capture_.emplace(std::move(*opened));
        thread_ = *thread;
    }
    capture_->cancel();
    const auto begun = capture_->begin(*request);
    return begun.has_value() ? state() : error_response(400, begun.error().str());
}

Response HalService::scope(std::string_view method, std::string_view body) {
    if (method == "POST") {
        return begin(body);
    }
    if (host() == nullptr) {
        return error_response(503, reason_);
    }
    if (method == "DELETE") {
        capture_.reset();
    }
    return state();
}

Response HalService::force() {
    if (host() == nullptr || !capture_.has_value()) {
        return error_response(409, "nothing is recorded");
    }
    capture_->force();
    return state();
}

Response HalService::record() {
    if (host() == nullptr || !capture_.has_value()) {
        return error_response(409, "nothing was recorded");
    }
    const auto record = capture_->record();
    if (!record.has_value()) {
        return error_response(409, record.error().str());
    }
    Json types = Json::array();
    for (const hal::Type type : record->types) {
        types.push_back(hal::type_name(type));
    }
    return document(Json{{"names", record->names},
                         {"types", std::move(types)},
                         {"times_s", record->times_s},
                         {"columns", record->columns},
                         {"moved", record->moved}});
}

}  // namespace mw::screen
