// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/setup/first_steps.hh"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "base/atomic_file.hh"
#include "base/text.hh"
#include "clients/screen/access/secrets.hh"
#include "clients/screen/files/files.hh"
#include "clients/screen/http/error_response.hh"
#include "machine/setup/files.hh"

namespace mw::screen {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view API = "/api/", HERE = "/api/first_steps";

Response document(const Json &json) {
    constexpr int COMPACT = -1;
    constexpr bool IS_ASCII = false;
    Response response;
    response.body = json.dump(COMPACT, ' ', IS_ASCII, Json::error_handler_t::replace);
    return response;
}

/// Parses an object; null if it is not an object.
Json object_of(const std::string &body) {
    constexpr bool HAS_EXCEPTIONS = false;
    const auto isFlat = [](int depth, Json::parse_event_t, Json &) { return depth < 4; };
    Json json = Json::parse(body, isFlat, HAS_EXCEPTIONS);
    return json.is_object() ? json : Json();
}

std::string text_at(const Json &json, const char *key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

std::optional<setup::Answers> answers_of(const Json &json) {
    setup::Answers answers;
    const auto found = json.is_object() ? json.find("answers") : json.end();
    if (!json.is_object() || found == json.end() || !found->is_object()) {
        return std::nullopt;
    }
    for (const auto &[key, value] : found->items()) {
        if (!value.is_string()) {
            return std::nullopt;
        }
        answers[key] = value.get<std::string>();
    }
    return answers;
}

const char *form_name(setup::Form form) {
    switch (form) {
    case setup::Form::CHOICE: return "choice";
    case setup::Form::NUMBER: return "number";
    case setup::Form::WHOLE: return "whole";
    case setup::Form::TEXT: break;
    }
    return "text";
}

Json faults_document(const std::vector<setup::Fault> &faults) {
    Json list = Json::array();
    for (const setup::Fault &fault : faults) {
        list.push_back({{"key", fault.key}, {"text", fault.text}});
    }
    return list;
}

/// Questions for the machine with these answers, their errors, and the resulting files.
Response questions_document(const std::string &body) {
    auto answers = answers_of(object_of(body));
    if (!answers.has_value()) {
        return error_response(400, R"(it is {"answers": {"kind": "mill", ...}}, texts only)");
    }
    const auto asked = setup::questions(*answers);
    Json list = Json::array();
    for (const setup::Question &question : asked) {
        Json one{{"key", question.key},       {"text", question.text},     {"form", form_name(question.form)},
                 {"preset", question.preset}, {"reason", question.reason}, {"unit", question.unit}};
        if (question.form == setup::Form::CHOICE) {
            one["choices"] = question.choices;
        } else if (question.form != setup::Form::TEXT) {
            one["min"] = question.low;
            one["max"] = question.high;
        }
        list.push_back(std::move(one));
    }
    // Answers to questions that are no longer asked are not errors, because the user may have gone back.
    std::erase_if(*answers, [&asked](const auto &answer) {
        return std::ranges::find(asked, answer.first, &setup::Question::key) == asked.end();
    });
    const auto planned = setup::plan_of(*answers);
    Json files = Json::array();
    if (planned.faults.empty()) {
        for (const setup::File &file : setup::machine_files(planned.plan)) {
            files.push_back({{"name", file.name}, {"text", file.text}});
        }
    }
    return document(Json{{"questions", std::move(list)},
                         {"faults", faults_document(planned.faults)},
                         {"files", std::move(files)}});
}

}  // namespace

void FirstSteps::answer(const Request &request, Reply reply) {
    const std::string &path = request.path, &method = request.method;
    if (!path.starts_with(API)) {
        const std::string page = path == "/" ? "/first.html" : path;
        disk_.run([folder = setup_.screen_folder, page] { return screen_file(folder, page); },
                  std::move(reply));
        return;
    }
    const auto key = request.query.find("key");
    if (key == request.query.end() || !areSame(key->second, setup_.key)) {
        reply(error_response(
            401, "open the address that 'millwright select --browser' has printed: it has a key"));
        return;
    }
    const auto later = [&](BackgroundJobs::Job job) { disk_.run(std::move(job), std::move(reply)); };
    const std::string what = path.starts_with(HERE) ? path.substr(HERE.size()) : "?";
    if (what.empty() && method == "GET") {
        later([this] { return list(); });
    } else if (what == "/picture" && method == "GET") {
        const auto ini = request.query.find("ini");
        later([this, name = ini == request.query.end() ? "" : ini->second] { return picture(name); });
    } else if (what == "/questions" && method == "POST") {
        reply(questions_document(request.body));
    } else if (what == "/machine" && method == "POST") {
        later([this, body = request.body] { return make(body); });
    } else if (what == "/trial" && method == "POST") {
        later([this, body = request.body] { return try_out(body); });
    } else if (what == "/start" && method == "POST") {
        start(request.body, std::move(reply));
    } else {
        reply(error_response(404, "no machine is running: there is no '" + printable(path) + "'"));
    }
}

Response FirstSteps::list() {
    found_ = setup_.find();
    Json groups = Json::array();
    for (const ChoiceGroup &group : found_) {
        Json choices = Json::array();
        for (const Choice &one : group.choices) {
            choices.push_back({{"ini", one.ini},
                               {"name", one.name},
                               {"machine", one.machine},
                               {"kind", one.kind},
                               {"axes", one.axes},
                               {"unit", one.unit},
                               {"notes", one.notes},
                               {"has_picture", !one.picture.empty()},
                               {"has_steps", one.hasSteps},
                               {"is_simulated", one.isSimulated}});
        }
        groups.push_back({{"title", group.title},
                          {"folder", group.folder},
                          {"is_copied", group.isCopied},
                          {"choices", std::move(choices)}});
    }
    return document(Json{
        {"groups", std::move(groups)}, {"last", setup_.last()}, {"proposed_folder", setup_.proposed_folder}});
}

Response FirstSteps::picture(const std::string &ini) {
    static constexpr std::array<std::pair<std::string_view, std::string_view>, 5> TYPES{
        {{".png", "image/png"},
         {".jpg", "image/jpeg"},
         {".jpeg", "image/jpeg"},
         {".gif", "image/gif"},
         {".svg", "image/svg+xml"}}};
    for (const ChoiceGroup &group : found_) {
        const auto found = std::ranges::find(group.choices, ini, &Choice::ini);
        const auto *const type =
            found == group.choices.end() ? TYPES.end() : std::ranges::find_if(TYPES, [&](const auto &one) {
                return to_lower(found->picture).ends_with(one.first);
            });
        if (type != TYPES.end()) {
            auto picture = read_file(found->picture);
            if (!picture.has_value()) {
                return error_response(404, picture.error().str());
            }
            Response response;
            response.type = type->second;
            response.body = std::move(*picture);
            return response;
        }
    }
    return error_response(404, "it has no picture");
}

Response FirstSteps::make(const std::string &body) {
    const Json json = object_of(body);
    const auto answers = answers_of(json);
    const std::string folder = json.is_object() ? text_at(json, "folder") : "";
    if (!answers.has_value() || !folder.starts_with('/')) {
        return error_response(400, R"(it is {"folder": "/whole/path", "answers": {...}})");
    }
    const auto planned = setup::plan_of(*answers);
    if (!planned.faults.empty()) {
        return document(Json{{"faults", faults_document(planned.faults)}});
    }
    const auto made = setup_.make(folder, planned.plan, *answers);
    if (!made.has_value()) {
        return error_response(409, made.error().str());
    }
    made_.push_back(*made);
    return document(Json{{"ini", made->ini}, {"program", made->program}});
}

Response FirstSteps::try_out(const std::string &body) {
    const Json json = object_of(body);
    const std::string ini = json.is_object() ? text_at(json, "ini") : "";
    const auto made = std::ranges::find(made_, ini, &FirstStepsSetup::Made::ini);
    if (made == made_.end()) {
        return error_response(404, "only a machine that was made here is tried");
    }
    const auto tried = setup_.try_out(*made);
    return document(Json{{"is_good", tried.has_value()},
                         {"output", printable(tried.has_value() ? *tried : tried.error().str())}});
}

bool FirstSteps::isListed(const std::string &ini) const {
    return std::ranges::find(made_, ini, &FirstStepsSetup::Made::ini) != made_.end() ||
           std::ranges::any_of(found_, [&](const ChoiceGroup &group) {
               return std::ranges::find(group.choices, ini, &Choice::ini) != group.choices.end();
           });
}

void FirstSteps::opened(SessionId session, Role role, Protection) {
    if (role >= Role::OPERATE) {
        trusted_.insert(session);
    }
}

void FirstSteps::received(SessionId session, std::string_view text) {
    if (session != operator_) {
        begin_steps(session, text);
    } else if (process_ != nullptr && text.find('\n') == std::string_view::npos) {
        process_->send(text);
    }
}

void FirstSteps::closed(SessionId session) {
    trusted_.erase(session);
    if (session == operator_) {
        end_steps();
    }
}

void FirstSteps::end_steps() {
    operator_ = 0;
    if (process_ != nullptr) {
        process_->close();
    }
}

void FirstSteps::reject_steps(SessionId session, const std::string &why) {
    sockets_.send(session, document(Json{{"state", "error"}, {"error", why}}).body);
}

/// Handles {"key", "ini"}: the first text of a socket.
void FirstSteps::begin_steps(SessionId session, std::string_view text) {
    const Json json = object_of(std::string(text));
    if (!json.is_object() || !trusted_.contains(session) || !areSame(text_at(json, "key"), setup_.key)) {
        return reject_steps(session, "the first text has the key of this page, and the INI file");
    }
    const std::string ini = text_at(json, "ini");
    const auto answer = [this, session, ini](const Response &response) {
        if (response.status != 200 || !trusted_.contains(session)) {
            return reject_steps(session, "only what is shown can be commissioned");
        }
        if (process_ != nullptr || chosen_.has_value()) {
            return reject_steps(session, "a machine is running: wait until it is off");
        }
        auto started = setup_.commission(ini);
        if (!started.has_value()) {
            return reject_steps(session, started.error().str());
        }
        process_ = std::move(*started);
        operator_ = session;
    };
    disk_.run([this, ini] { return isListed(ini) ? document(Json()) : error_response(404, "not listed"); },
              answer);
}

void FirstSteps::look() {
    if (process_ == nullptr) {
        return;
    }
    while (const auto line = process_->next_line()) {
        if (operator_ != 0) {
            sockets_.send(operator_, *line);
        }
    }
    if (process_->hasEnded()) {
        process_.reset();
        if (operator_ != 0) {
            sockets_.close(std::exchange(operator_, 0));
        }
    }
}

void FirstSteps::start(const std::string &body, Reply reply) {
    if (isCommissioning()) {
        reply(error_response(409, "the steps at a machine are running: leave them first"));
        return;
    }
    auto ini = std::make_shared<std::string>();
    disk_.run(
        [this, body, ini] {
            const Json json = object_of(body);
            const std::string wanted = json.is_object() ? text_at(json, "ini") : "";
            if (!isListed(wanted)) {
                return error_response(404, "only what is shown can be started");
            }
            const auto prepared = setup_.prepare(wanted);
            if (!prepared.has_value()) {
                return error_response(409, prepared.error().str());
            }
            *ini = prepared->ini;
            return document(Json{{"ini", prepared->ini}, {"port", prepared->port}});
        },
        [this, ini, reply = std::move(reply)](Response response) {
            const bool is_chosen = response.status == 200;
            reply(std::move(response));
            if (is_chosen) {
                chosen_ = *ini;
            }
        });
}

}  // namespace mw::screen
