// SPDX-License-Identifier: GPL-2.0-or-later
// An agent of MTConnect: the machine's observations and tools, and the answers to requests. It uses no
// sockets.
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
    std::size_t buffer = 131072;  ///< number of stored observations
};

/// A document and its HTTP status.
struct Answer {
    int status = 200;
    std::string body;
};

/// A stream of documents that a client has requested.
struct Stream {
    std::optional<Filter> filter;  ///< nothing: all items
    bool isCurrent = false;        ///< sends states instead of observations
    Sequence next = 0;
    std::size_t count = 0;  ///< maximum number of observations in a document
    double interval_s = 0, heartbeat_s = 10;
    double sent_s = 0;           ///< time of the last document
    std::uint64_t instance = 0;  ///< instance for which its sequence numbers are valid
    bool isEnded = false;
};

/// Decoded parameters of a request.
using Query = std::map<std::string, std::string>;

/// Any thread.
class Agent {
  public:
    static constexpr std::size_t MOST_ASSETS = static_cast<std::size_t>(messages::MAX_TOOLS);

    Agent(AgentSettings settings, TimeMs now);

    // --- for the thread that reads the machine

    /// Called when the machine is running. Other metrics than before begin a new instance.
    void born(const std::vector<Metric> &metrics, const std::vector<Value> &values, double units_per_mm,
              TimeMs now);
    void add(const std::vector<Change> &changes, TimeMs now);
    /// Called when no data of the machine is available.
    void gone(TimeMs now);
    void set_tools(const messages::ToolTable &table, TimeMs now);

    // --- for the thread of the clients

    /// Returns a document, or a stream whose documents next() returns.
    std::variant<Answer, Stream> answer(const std::string &path, const Query &query, TimeMs now,
                                        double now_s) const;
    /// The next document of a stream, when it is due; `now_s` is monotonic.
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
    /// At most `count` observations beginning with `from`; backwards if `count` is negative. `from` becomes
    /// the next one.
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
    std::vector<Asset> assets_;  ///< newest asset first
};

}  // namespace mw::publish::mtconnect
