// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/files/offered_programs.hh"

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/text.hh"
#include "clients/screen/http/error_response.hh"

namespace mw::screen {
namespace {

using nlohmann::json;

constexpr int OK = 200, BAD_REQUEST = 400, NOT_FOUND = 404, CONFLICT = 409, UNAVAILABLE = 503;
/// Number of ended offers in the list.
constexpr std::size_t MOST_ENDED = 20;

offers::TimeMs utc_ms() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return static_cast<offers::TimeMs>(std::chrono::duration_cast<std::chrono::milliseconds>(now).count());
}

json document_of(const offers::Entry &entry) {
    return {{"id", entry.standing.id},
            {"name", entry.name},
            {"from", entry.from},
            {"note", entry.note},
            {"parts", entry.parts},
            {"bytes", entry.bytes},
            {"files", entry.files},
            {"received_ms", entry.received},
            {"state", offers::name_of(entry.standing.state)},
            {"at_ms", entry.standing.at},
            {"by", entry.standing.by},
            {"reason", entry.standing.reason},
            {"job", entry.isJob}};
}

/// True if there is a file, folder or link that is not a file with this text.
bool isOther(const std::string &path, const std::string &text) {
    struct stat facts{};
    if (::lstat(path.c_str(), &facts) != 0) {
        return false;
    }
    const auto found = read_file(path, text.size() + 1);
    return !found.has_value() || *found != text;
}

Result<> as_result(const Response &written) {
    if (written.status == OK) {
        return {};
    }
    const auto document = json::parse(written.body, nullptr, false);
    return fail(document.is_object() && document.contains("error") ? document["error"].get<std::string>()
                                                                   : written.body);
}

}  // namespace

Response OfferedPrograms::list() const {
    auto list = json::array();
    if (!folder_.empty()) {
        const auto box = offers::OfferBox::open(folder_);
        const auto entries = box.has_value() ? box->entries() : std::unexpected(box.error());
        if (!entries.has_value()) {
            return error_response(UNAVAILABLE, entries.error().str());
        }
        std::size_t ended = 0;
        for (auto entry = entries->rbegin(); entry != entries->rend(); ++entry) {
            const bool isCurrent = entry->isJob || entry->standing.state == offers::State::RECEIVED;
            if (!entry->name.empty() && (isCurrent || ended++ < MOST_ENDED)) {
                list.push_back(document_of(*entry));
            }
        }
    }
    return {.body = json{{"enabled", !folder_.empty()}, {"offers", std::move(list)}}.dump()};
}

Response OfferedPrograms::read(const std::string &id) const {
    const auto box = folder_.empty() ? Result<offers::OfferBox>(fail("This machine receives no offers."))
                                     : offers::OfferBox::open(folder_);
    const auto offer = box.has_value() ? box->read(id) : std::unexpected(box.error());
    return offer.has_value() ? Response{.body = offers::encode(*offer)}
                             : error_response(NOT_FOUND, offer.error().str());
}

Result<OfferedPrograms::Decision> OfferedPrograms::read_decision(const std::string &body) {
    const auto document = json::parse(body, nullptr, false);
    const auto text = [&document](const char *name) {
        const auto found = document.find(name);
        return found != document.end() && found->is_string() ? found->get<std::string>() : std::string();
    };
    if (!document.is_object()) {
        return fail("The decision is not a JSON object.");
    }
    Decision decision{text("decision"), text("by"), text("reason"), false};
    const auto replace = document.find("replace");
    decision.isReplacing = replace != document.end() && replace->is_boolean() && replace->get<bool>();
    const bool isKnown =
        decision.decision == "accept" || decision.decision == "decline" || decision.decision == "finish";
    if (!isKnown) {
        return fail("The decision must be accept, decline or finish.");
    }
    constexpr std::size_t MOST_NAME = 50;
    if (decision.by.size() > MOST_NAME || !offers::isPlainText(decision.by)) {
        return fail(fmt::format("The name of the operator is longer than {} bytes or has control characters.",
                                MOST_NAME));
    }
    return decision;
}

/// Names of files that an acceptance replaces.
Result<std::vector<std::string>> OfferedPrograms::replaced(const offers::Offer &offer,
                                                           const ProgramUse &use) const {
    std::vector<std::string> names;
    for (const offers::OfferedFile &file : offer.files) {
        const auto path = files_.path_of(file.name);
        if (!path.has_value()) {
            return std::unexpected(path.error());
        }
        if (!isOther(*path, file.text)) {
            continue;
        }
        if (*path == use.open) {
            return fail(fmt::format(
                "{} is open and would be replaced. Open another program, then accept the offer.", file.name));
        }
        names.push_back(file.name);
    }
    return names;
}

Response OfferedPrograms::accept(offers::OfferBox &box, const std::string &id, const Decision &decision,
                                 const ProgramUse &use) {
    if (use.isRunning) {
        return error_response(CONFLICT, "A program is running. Accept the offer when it has ended.");
    }
    std::vector<std::string> names;
    const auto put = [&](const offers::Offer &offer) -> Result<> {
        const auto found = replaced(offer, use);
        if (!found.has_value()) {
            return std::unexpected(found.error());
        }
        if (!found->empty() && !decision.isReplacing) {
            names = *found;
            return fail(fmt::format("{} exists with another content.", fmt::join(names, ", ")));
        }
        // The program is the last file, so that it is complete when it appears.
        for (auto file = offer.files.rbegin(); file != offer.files.rend(); ++file) {
            auto written = as_result(files_.write(file->name, 0, file->text.size(), file->text));
            if (!written.has_value()) {
                return written;
            }
        }
        return {};
    };
    const auto accepted = box.accept(id, decision.by, utc_ms(), put);
    if (accepted.has_value()) {
        return {.body = "{}"};
    }
    json document{{"error", printable(accepted.error().str())}};
    if (!names.empty()) {
        document["replaces"] = names;
    }
    return {.status = CONFLICT, .body = document.dump(-1, ' ', false, json::error_handler_t::replace)};
}

Response OfferedPrograms::decide(const std::string &id, const std::string &body, const Requester &by,
                                 const ProgramUse &use) {
    auto decision = read_decision(body);
    if (!decision.has_value()) {
        return error_response(BAD_REQUEST, decision.error().message);
    }
    if (folder_.empty()) {
        return error_response(NOT_FOUND, "This machine receives no offers.");
    }
    auto box = offers::OfferBox::open(folder_);
    if (!box.has_value()) {
        return error_response(UNAVAILABLE, box.error().str());
    }
    decision->by = decision->by.empty() ? by.address : fmt::format("{} ({})", decision->by, by.address);
    if (decision->decision == "accept") {
        return accept(*box, id, *decision, use);
    }
    const auto done = decision->decision == "decline"
                          ? box->decline(id, decision->by, decision->reason, utc_ms())
                          : box->finish(id);
    return done.has_value() ? Response{.body = "{}"} : error_response(CONFLICT, done.error().str());
}

}  // namespace mw::screen
