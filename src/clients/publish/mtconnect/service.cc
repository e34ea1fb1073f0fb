// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/mtconnect/service.hh"

#include <utility>

#include <fmt/format.h>

namespace mw::publish::mtconnect {
namespace {

constexpr const char *BOUNDARY = "millwright-part-9f3b1c77d0a24e5f";
constexpr const char *XML = "application/xml";

std::string part(const std::string &document) {
    return fmt::format("--{}\r\nContent-type: {}\r\nContent-length: {}\r\n\r\n{}\r\n", BOUNDARY, XML,
                       document.size(), document);
}

}  // namespace

Service::Service(const Agent &agent, Clock clock) : agent_(agent), clock_(std::move(clock)) {}

void Service::answer(const screen::Request &request, screen::Reply reply) {
    if (request.method != "GET") {
        reply({.status = 405,
               .type = "text/plain",
               .body = "The agent only answers GET: it cannot be written to.\n"});
        return;
    }
    auto answer = agent_.answer(request.path, request.query, clock_.utc_ms(), clock_.steady_s());
    if (auto *const document = std::get_if<Answer>(&answer)) {
        reply({.status = document->status, .type = XML, .body = std::move(document->body)});
        return;
    }
    Running running{std::get<Stream>(std::move(answer)), std::make_shared<screen::PieceQueue>()};
    reply({.status = 200,
           .type = fmt::format("multipart/x-mixed-replace;boundary={}", BOUNDARY),
           .pieces = running.pieces});
    streams_.push_back(std::move(running));
}

bool Service::tick() {
    for (Running &one : streams_) {
        // A client that does not read fills its queue, and the server closes its connection later. Nothing
        // waits for the client.
        const bool isFull = !one.pieces->hasRoom();
        const auto document =
            isFull ? std::nullopt : agent_.next(one.stream, clock_.utc_ms(), clock_.steady_s());
        if (document.has_value()) {
            static_cast<void>(one.pieces->push(part(*document)));
        }
        if (isFull || one.stream.isEnded) {
            one.stream.isEnded = true;
            one.pieces->end();
        }
    }
    std::erase_if(streams_,
                  [](const Running &one) { return one.stream.isEnded || one.pieces->isCancelled(); });
    return !streams_.empty();
}

}  // namespace mw::publish::mtconnect
