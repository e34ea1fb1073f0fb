// SPDX-License-Identifier: GPL-2.0-or-later
// An agent of MTConnect: the machine's observations and tools, and its answers to requests. Knows no sockets.
#pragma once

#include <cstdint>
#include <expected>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "clients/publish/mtconnect/device_model.hh"
#include "clients/publish/mtconnect/documents.hh"
#include "clients/publish/mtconnect/observations.hh"

namespace mw::publish::mtconnect {

struct AgentSettings {
    std::string device;  ///< name of the machine
    std::string uuid;
    std::string sender;           ///< name of this computer
    std::size_t buffer = 131072;  ///< observations that are kept
};

/// A document and its status in HTTP.
struct Answer {
    int status = 200;
    std::string body;
};

/// A stream of documents that a client has requested.
struct Stream {
    std::optional<Filter> filter;  ///< nothing: all items
    bool isCurrent = false;        ///< states instead of observations
    Sequence next = 0;
    std::size_t count = 0;  ///< observations in a document, at most
    double interval_s = 0, heartbeat_s = 10;
    double sent_s = 0;           ///< time of the last document
    std::uint64_t instance = 0;  ///< for which its sequence numbers hold
    bool isEnded = false;
};

/// Parameters of a request, decoded.
using Query = std::map<std::string, std::string>;

/// Any thread.
class Agent {
  public:
    static constexpr std::size_t MOST_ASSETS = static_cast<std::size_t>(messages::MAX_TOOLS);

    Agent(AgentSettings settings, TimeMs now);

    // Of the thread that reads the machine.

    /// The machine is there. Other metrics than before begin a new instance.
    void born(const std::vector<Metric> &metrics, const std::vector<Value> &values, double units_per_mm,
              TimeMs now);
    void add(const std::vector<Change> &changes, TimeMs now);
    /// Nothing of the machine is known any more.
    void gone(TimeMs now);
    void set_tools(const messages::ToolTable &table, TimeMs now);

    // Of the thread of the clients.

    /// A document, or a stream whose documents next() gives.
    std::variant<Answer, Stream> answer(const std::string &path, const Query &query, TimeMs now,
                                        double now_s) const;
    /// The next document of a stream, when it is time for one; `now_s` never jumps.
    std::optional<std::string> next(Stream &stream, TimeMs now, double now_s) const;

  private:
    struct Failure {
        int status = 400;
        std::string code, text;
    };
    template <class T>
    using Outcome = std::expected<T, Failure>;

    AgentFacts facts() const;
    Span span() const { return {observations_.first(), observations_.last(), observations_.next()}; }
    void set(ItemId item, std::string value, TimeMs now);
    Outcome<std::variant<Answer, Stream>> find_answer(std::string path, const Query &query, TimeMs now,
                                                      double now_s) const;
    Outcome<std::variant<Answer, Stream>> current(const Query &query, TimeMs now, double now_s) const;
    Outcome<std::variant<Answer, Stream>> sample(const Query &query, TimeMs now, double now_s) const;
    Outcome<std::variant<Answer, Stream>> assets(const std::string &ids, const Query &query,
                                                 TimeMs now) const;
    Outcome<std::optional<Filter>> filter(const Query &query) const;
    Outcome<std::optional<Stream>> stream(const Query &query, double now_s) const;
    std::string current_document(const std::optional<Filter> &filter, std::optional<Sequence> at,
                                 TimeMs now) const;
    /// From `from` on, `count` observations at most, backwards where it is negative; `from` becomes the next
    /// one.
    std::string sample_document(const std::optional<Filter> &filter, Sequence &from, std::int64_t count,
                                TimeMs now) const;

    AgentSettings settings_;
    mutable std::mutex mutex_;
    DeviceModel model_;
    std::vector<Metric> metrics_;
    Observations observations_;
    std::uint64_t instance_;
    TimeMs model_changed_;
    double units_per_mm_ = 1;
    std::vector<Asset> assets_;  ///< the newest first
};

}  // namespace mw::publish::mtconnect
