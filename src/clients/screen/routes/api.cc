// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/routes/api.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/duration.hh"
#include "base/text.hh"
#include "clients/screen/access/access.hh"
#include "clients/screen/facts/machine_document.hh"
#include "clients/screen/facts/panel.hh"
#include "clients/screen/http/error_response.hh"
#include "clients/screen/status/schema.hh"
#include "messages/declarations/json.hh"

namespace mw::screen {
namespace {

constexpr std::string_view API = "/api/", FILES = "/api/files/", OFFERS = "/api/offers", HAL = "/api/hal/",
                           SCOPE = "/api/scope", INPUTS = "/api/inputs";

/// Data that a screen needs to show the status of the machine.
constexpr std::array<std::string_view, 4> OF_STATUS{"/api/icon", "/api/machine", "/api/schema", "/api/tools"};

Response not_allowed(Role needed) {
    return error_response(403, fmt::format("this needs a token of the role {}", role_name(needed)));
}

Response document(std::string body) {
    Response response;
    response.body = std::move(body);
    return response;
}

Response wrong_method(const Request &request) {
    return error_response(400, "'" + printable(request.method) + "' is not possible with " +
                                   printable(request.path));
}

/// A whole number of the query.
std::optional<std::uint64_t> number(const Request &request, const char *name) {
    const auto found = request.query.find(name);
    return found == request.query.end() ? std::nullopt : parse_uint(found->second);
}

}  // namespace

Api::Api(Sockets &sockets, const Threads &threads, ApiSetup setup, Clock clock)
    : threads_(threads), setup_(std::move(setup)), clock_(std::move(clock)),
      screens_(sockets, setup_.screens), files_(setup_.facts.program_prefix, setup_.facts.program_extensions),
      offers_(setup_.offers_folder, files_), keepsakes_(setup_.facts), log_(setup_.facts.files.log),
      hal_(setup_.connect_hal, setup_.dialogs, setup_.begin_hal), hasHalBegun_(setup_.begin_hal == nullptr) {
    if (!setup_.facts.files.log.empty()) {
        screens_.keep_log([this](const std::string &line, std::int64_t age_ns) { write_log(line, age_ns); });
    }
    for (const Tab &tab : setup_.facts.tabs) {
        if (tab.kind == Tab::Kind::PANEL) {
            const auto names = settable_names(tab.content);
            operable_.insert(operable_.end(), names.begin(), names.end());
        }
    }
}

/// Reports the first line that cannot be written, and then stops writing.
void Api::write_log(const std::string &line, std::int64_t age_ns) {
    const auto failed = std::make_shared<std::string>();
    threads_.disk.run(
        [this, failed, line, when = std::time(nullptr) - age_ns / NS_PER_SECOND] {
            const auto added = log_.add(when, line);
            *failed = added.has_value() ? "" : added.error().message;
            return Response{};
        },
        [this, failed](const Response &) {
            if (!failed->empty() && screens_.isLogKept()) {
                screens_.keep_log({});
                screens_.tell_note(*failed);
            }
        });
}

Role Api::needed_role(const Request &request) const {
    if (request.method == "GET") {
        return std::ranges::find(OF_STATUS, request.path) != OF_STATUS.end() ? Role::STATUS : Role::VIEW;
    }
    const bool is_hal = request.path.starts_with(HAL);
    if (!is_hal && !request.path.starts_with(SCOPE)) {
        return Role::OPERATE;
    }
    // A HAL value can move anything, in any state of the machine; values of a panel are for operators.
    const bool of_panel =
        is_hal && std::ranges::find(operable_, request.path.substr(HAL.size())) != operable_.end();
    return of_panel ? Role::OPERATE : Role::CONFIGURE;
}

bool Api::isKeepsake(const Request &request, Reply &reply) {
    using Read = Response (*)(const UserFiles &, const Request &);
    static constexpr std::array<std::pair<std::string_view, Read>, 5> ROUTES{
        {{"/api/mdi_history",
          [](const UserFiles &keep, const Request &asked) { return keep.mdi_history(asked); }},
         {"/api/preferences",
          [](const UserFiles &keep, const Request &asked) { return keep.preferences(asked); }},
         {"/api/icon", [](const UserFiles &keep, const Request &) { return keep.icon(); }},
         {"/api/offsets", [](const UserFiles &keep, const Request &) { return keep.offsets(); }},
         {"/api/certificate", [](const UserFiles &keep, const Request &) { return keep.certificate(); }}}};
    const auto *const found =
        std::ranges::find(ROUTES, request.path, &std::pair<std::string_view, Read>::first);
    if (found == ROUTES.end()) {
        return false;
    }
    threads_.disk.run([this, request, read = found->second] { return read(keepsakes_, request); },
                      std::move(reply));
    return true;
}

void Api::tick() {
    const std::int64_t now_ns = clock_();
    screens_.tick(now_ns);
    if (now_ns >= next_watch_ns_ && !hal_read_) {
        next_watch_ns_ = now_ns + WATCH_NS;
        look_at_hal();
    }
}

void Api::closed(SessionId session) {
    screens_.closed(session);
    if (screens_.count() == 0) {  // no screen shows the oscilloscope, so it is removed from the servo thread
        threads_.hal.run([this] { return hal_.scope("DELETE", ""); }, [](const Response &) {});
    }
}

void Api::look_at_hal() {
    auto names = screens_.watched();
    if (names.empty() && setup_.dialogs.empty() && hasHalBegun_) {
        return;
    }
    hal_read_ = true;
    const auto news = std::make_shared<HalService::News>();
    threads_.hal.run(
        [this, news, names = std::move(names)] {
            *news = hal_.look(names);
            return Response{};
        },
        [this, news](const Response &) {
            hal_read_ = false;
            hasHalBegun_ = news->has_begun;
            screens_.tell_values(news->values);
            screens_.tell_questions(news->questions);
            for (const std::string &note : news->notes) {
                screens_.tell_note(note);
            }
        });
}

void Api::answer_hal(const Request &request, Reply reply) {
    const auto later = [&](BackgroundJobs::Job job) { threads_.hal.run(std::move(job), std::move(reply)); };
    const std::string &path = request.path, &method = request.method;
    if (path == "/api/hal" && method == "GET") {
        const auto glob = request.query.find("glob");
        later([this, text = glob == request.query.end() ? "*" : glob->second] { return hal_.list(text); });
    } else if (path == INPUTS && method == "GET") {
        later([this] { return hal_.inputs(); });
    } else if (path.starts_with(HAL) && path.size() > HAL.size() && method == "PUT") {
        later([this, name = path.substr(HAL.size()), body = request.body] { return hal_.set(name, body); });
    } else if (path == "/api/questions" && method == "POST") {
        later([this, body = request.body] { return hal_.answer(body); });
    } else if (path == "/api/scope" && (method == "GET" || method == "POST" || method == "DELETE")) {
        later([this, method, body = request.body] { return hal_.scope(method, body); });
    } else if (path == "/api/scope/record" && method == "GET") {
        later([this] { return hal_.record(); });
    } else if (path == "/api/scope/force" && method == "POST") {
        later([this] { return hal_.force(); });
    } else {
        reply(wrong_method(request));
    }
}

void Api::answer(const Request &request, Reply reply) {
    const std::string &path = request.path;
    const Role needed = needed_role(request);
    if (path.starts_with(API) && request.role < needed) {
        reply(not_allowed(needed));
        return;
    }
    const bool of_hal = path == "/api/hal" || path.starts_with(HAL) || path.starts_with(SCOPE);
    if (of_hal || path == "/api/questions" || path == INPUTS) {
        answer_hal(request, std::move(reply));
        return;
    }
    if (isKeepsake(request, reply)) {
        return;
    }
    if (path.starts_with(OFFERS)) {
        answer_offers(request, std::move(reply));
        return;
    }
    if (path == "/api/files" || path.starts_with(FILES)) {
        answer_files(request, path.size() > FILES.size() ? path.substr(FILES.size()) : "", std::move(reply));
        return;
    }
    if (path == "/api/filter" && request.method == "POST") {
        reply(answer_filter(request));
    } else if (request.method != "GET") {
        reply(wrong_method(request));
    } else if (path == "/api/schema") {
        reply(document(schema_document()));
    } else if (path == "/api/machine") {
        reply(document(machine_document(setup_.facts)));
    } else if (path == "/api/path") {
        reply(answer_path(request));
    } else if (path == "/api/times") {
        reply(answer_times(request));
    } else if (path == "/api/tools") {
        reply(answer_tools());
    } else if (path == "/metrics") {
        reply(metrics());
    } else if (path.starts_with(API)) {
        reply(error_response(404, "there is no '" + path + "'; docs/reference/api.md names what there is"));
    } else {
        threads_.disk.run([folder = setup_.screen_folder, path] { return screen_file(folder, path); },
                          std::move(reply));
    }
}

void Api::read(std::shared_ptr<BodySource> source, std::function<void(std::string)> take) {
    threads_.disk.run([source = std::move(source)] { return Response{.body = source->read()}; },
                      [take = std::move(take)](Response read) { take(std::move(read.body)); });
}

void Api::answer_files(const Request &request, const std::string &name, Reply reply) {
    if (name.empty()) {
        if (request.method != "GET") {
            reply(wrong_method(request));
            return;
        }
        threads_.disk.run([this] { return files_.list(); }, std::move(reply));
    } else if (request.method == "GET" && request.query.contains("former")) {
        threads_.disk.run([this, name] { return files_.read_former(name); }, std::move(reply));
    } else if (request.method == "GET") {
        const auto made = request.query.contains("made") ? made_of(name) : std::nullopt;
        threads_.disk.run([this, name, made] { return files_.read(name, made); }, std::move(reply));
    } else if (request.method == "DELETE") {
        threads_.disk.run([this, name] { return files_.remove(name); }, std::move(reply));
    } else if (request.method == "PUT") {
        write_file(request, name, std::move(reply));
    } else {
        reply(wrong_method(request));
    }
}

void Api::answer_offers(const Request &request, Reply reply) {
    const std::string id =
        request.path.size() > OFFERS.size() + 1 ? request.path.substr(OFFERS.size() + 1) : "";
    if (request.method == "GET") {
        threads_.disk.run([this, id] { return id.empty() ? offers_.list() : offers_.read(id); },
                          std::move(reply));
        return;
    }
    if (request.method != "POST" || id.empty()) {
        reply(wrong_method(request));
        return;
    }
    ProgramUse use;
    if (const messages::MachineStatus *const status = screens_.status(); status != nullptr) {
        use = {status->task.interp_state != messages::InterpState::IDLE, status->task.program.str()};
    }
    threads_.disk.run(
        [this, id, use, body = request.body, by = Requester{request.address, request.role}] {
            return offers_.decide(id, body, by, use);
        },
        std::move(reply));
}

namespace {

/// Extensions of files that filters read as data. A filter may execute other files: [FILTER] py = python3.
constexpr std::array<std::string_view, 12> DATA_EXTENSIONS{".png",  ".gif", ".jpg", ".jpeg", ".bmp", ".tif",
                                                           ".tiff", ".pgm", ".svg", ".dxf",  ".stl", ".gbr"};

bool isData(const std::string &name) {
    const std::string lower = to_lower(name);
    return std::ranges::any_of(DATA_EXTENSIONS, [&](std::string_view one) { return lower.ends_with(one); });
}

}  // namespace

void Api::write_file(const Request &request, const std::string &name, Reply reply) {
    if (request.role < Role::CONFIGURE && made_of(name).has_value() && !isData(name)) {
        const std::size_t dot = name.rfind('.');
        reply(error_response(403, "Files of type " + printable(name.substr(dot)) +
                                      " are run as programs of this computer: a client of role configure can "
                                      "add them"));
        return;
    }
    const bool is_piece = request.query.contains("offset") || request.query.contains("size");
    const auto offset = is_piece ? number(request, "offset") : 0;
    const auto size = is_piece ? number(request, "size") : request.body.size();
    if (!offset.has_value() || !size.has_value()) {
        reply(error_response(400, "a piece of a file needs ?offset=N&size=TOTAL, whole numbers of bytes"));
        return;
    }
    threads_.disk.run([this, name, offset = *offset, size = *size,
                       piece = request.body] { return files_.write(name, offset, size, piece); },
                      std::move(reply));
}

namespace {

Response stream(Result<std::shared_ptr<PieceQueue>> pieces) {
    if (!pieces.has_value()) {
        return error_response(429, pieces.error().str());
    }
    Response response;
    response.type = "application/octet-stream";
    response.pieces = std::move(*pieces);
    return response;
}

/// A number of at least 0 in the query; nothing for other values.
std::optional<double> factor(const Request &request, const char *name, double preset) {
    const auto found = request.query.find(name);
    const auto value = found == request.query.end() ? std::optional(preset) : parse_double(found->second);
    return value.has_value() && std::isfinite(*value) && *value >= 0 ? value : std::nullopt;
}

}  // namespace

Response Api::answer_path(const Request &request) {
    const auto name = request.query.find("file");
    if (name == request.query.end()) {
        return error_response(400, "the path of which program? /api/path?file=NAME");
    }
    const auto path = program_of(name->second);
    return path.has_value() ? stream(setup_.read_path(*path, {request.address, request.role}))
                            : error_response(400, path.error().str());
}

Response Api::answer_times(const Request &request) {
    const auto name = request.query.find("file");
    const auto feed = factor(request, "feed", 1), rapid = factor(request, "rapid", 1),
               most = factor(request, "max_velocity", 0);
    constexpr double LEAST = 0.001;  // an override of 0 would take infinitely long
    if (name == request.query.end() || !feed || !rapid || !most || *feed < LEAST || *rapid < LEAST) {
        return error_response(
            400, "/api/times?file=NAME&feed=1&rapid=1&max_velocity=0: overrides of at least 0.001");
    }
    const auto path = program_of(name->second);
    if (!path.has_value()) {
        return error_response(400, path.error().str());
    }
    return stream(setup_.read_times(*path, {*feed, *rapid, *most}, {request.address, request.role}));
}

std::optional<std::string> Api::made_of(const std::string &name) const {
    const std::string lower = to_lower(name);
    const auto &all = setup_.facts.filters.extensions;
    const bool filtered =
        std::ranges::any_of(all, [&](const std::string &one) { return lower.ends_with(one); });
    return filtered ? std::optional(setup_.facts.filters.folder + '/' + name + ".ngc") : std::nullopt;
}

Result<std::string> Api::program_of(const std::string &name) const {
    auto path = files_.path_of(name);
    const auto made = path.has_value() ? made_of(name) : std::nullopt;
    return made.has_value() ? Result<std::string>(*made) : path;
}

Response Api::answer_filter(const Request &request) {
    const auto name = request.query.find("file");
    const auto path =
        name == request.query.end() ? Result<std::string>(fail("which file?")) : files_.path_of(name->second);
    if (!path.has_value()) {
        return error_response(400, path.error().str());
    }
    const auto made = made_of(name->second);
    if (!made.has_value()) {
        return error_response(400, "[FILTER] has no program for '" + printable(name->second) + "'");
    }
    Response response = stream(setup_.run_filter(*path, *made, {request.address, request.role}));
    response.type = response.pieces != nullptr ? "application/x-ndjson" : response.type;
    return response;
}

Response Api::answer_tools() {
    const auto table = screens_.tools();
    return table.has_value() ? document(messages::to_json(messages::object(*table)))
                             : error_response(503, table.error().str());
}

Response Api::metrics() const {
    const Counts &counts = screens_.counts();
    Response response;
    response.type = "text/plain; version=0.0.4; charset=utf-8";
    const auto add = [&response](const char *name, const char *kind, const char *help, double value) {
        response.body +=
            fmt::format("# HELP millwright_{0} {1}\n# TYPE millwright_{0} {2}\nmillwright_{0} {3}\n", name,
                        help, kind, to_text(value));
    };
    add("machine_up", "gauge", "1: the server is a client of a machine", screens_.isMachineUp() ? 1 : 0);
    add("screens", "gauge", "open sockets", static_cast<double>(screens_.count()));
    add("commands_total", "counter", "commands of screens, without stops",
        static_cast<double>(counts.commands));
    add("stops_total", "counter", "stops of screens", static_cast<double>(counts.stops));
    add("refused_total", "counter", "commands refused", static_cast<double>(counts.refused));
    add("statuses_total", "counter", "statuses sent", static_cast<double>(counts.statuses));
    add("messages_total", "counter", "messages to the operator", static_cast<double>(counts.messages));
    if (const messages::MachineStatus *status = screens_.status()) {
        add("task_cycles_total", "counter", "cycles of task", static_cast<double>(status->cycle));
        add("servo_cycles_total", "counter", "cycles of motion", static_cast<double>(status->motion.cycle));
        add("state", "gauge", "1 e-stop, 2 reset, 3 off, 4 on", static_cast<double>(status->task.state));
        add("interpreter_state", "gauge", "1 idle, 2 reading, 3 paused, 4 waiting",
            static_cast<double>(status->task.interp_state));
        add("programs_ended_total", "counter", "programs that have ended",
            static_cast<double>(status->task.programs_ended));
    }
    return response;
}

}  // namespace mw::screen
