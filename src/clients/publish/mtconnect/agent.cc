// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/mtconnect/agent.hh"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/text.hh"
#include "clients/publish/mtconnect/forms.hh"

namespace mw::publish::mtconnect {
namespace {

constexpr std::size_t PRESET_COUNT = 100;
constexpr double MS_PER_S = 1000;
constexpr std::int64_t MOST_MS = 86'400'000;

std::string id_of(const messages::ToolRecord &tool) {
    return fmt::format("tool-{}", tool.toolno);
}

std::string text_of(const Query &query, const char *name) {
    const auto found = query.find(name);
    return found == query.end() ? std::string() : found->second;
}

bool isSame(const messages::ToolRecord &a, const messages::ToolRecord &b) {
    return a.toolno == b.toolno && a.pocketno == b.pocketno && a.offset == b.offset &&
           a.diameter == b.diameter && a.comment == b.comment;
}

}  // namespace

Agent::Agent(AgentSettings settings, TimeMs now)
    : settings_(std::move(settings)), model_(settings_.device, settings_.uuid, {}),
      observations_(model_.items().size(), settings_.buffer, now), instance_(now / 1000),
      model_changed_(now) {}

AgentFacts Agent::facts() const {
    const auto present = std::ranges::count(assets_, false, &Asset::isRemoved);
    return {settings_.sender,
            instance_,
            model_changed_,
            observations_.capacity(),
            static_cast<std::size_t>(present),
            MOST_ASSETS};
}

void Agent::set(ItemId item, std::string value, TimeMs now) {
    if (observations_.value(item) != value) {
        observations_.add(item, std::move(value), now);
    }
}

void Agent::born(const std::vector<Metric> &metrics, const std::vector<Value> &values, double units_per_mm,
                 TimeMs now) {
    const std::lock_guard lock(mutex_);
    units_per_mm_ = units_per_mm;
    if (metrics != metrics_) {
        metrics_ = metrics;
        model_ = DeviceModel(settings_.device, settings_.uuid, metrics_);
        observations_ = Observations(model_.items().size(), settings_.buffer, now);
        instance_ = std::max<std::uint64_t>(instance_ + 1, now / 1000);
        model_changed_ = now;
    }
    set(model_.availability(), "AVAILABLE", now);
    for (ItemId i = 0; i < model_.items().size(); ++i) {
        const DataItem &item = model_.items()[i];
        if (item.metric.has_value() && item.row != nullptr) {
            set(i, value_text(item, values[*item.metric], units_per_mm_), now);
        }
    }
}

void Agent::add(const std::vector<Change> &changes, TimeMs now) {
    const std::lock_guard lock(mutex_);
    for (const Change &change : changes) {
        const auto item = model_.item_of(change.metric);
        if (!item.has_value()) {
            continue;
        }
        const DataItem &one = model_.items()[*item];
        std::string text = value_text(one, change.value, units_per_mm_);
        if (one.row == nullptr) {  // the same message twice is two messages
            observations_.add(*item, std::move(text), now);
        } else {
            set(*item, std::move(text), now);
        }
    }
}

void Agent::gone(TimeMs now) {
    const std::lock_guard lock(mutex_);
    for (ItemId i = 0; i < model_.items().size(); ++i) {
        set(i, UNAVAILABLE, now);
    }
}

void Agent::set_tools(const messages::ToolTable &table, TimeMs now) {
    const std::lock_guard lock(mutex_);
    std::set<int> present;
    for (const messages::ToolRecord &tool : table.tools) {
        // The first entry is the spindle, which repeats its tool.
        if (tool.toolno <= 0 || !present.insert(tool.toolno).second) {
            continue;
        }
        const auto known = std::ranges::find_if(
            assets_, [&tool](const Asset &one) { return one.tool.toolno == tool.toolno; });
        if (known != assets_.end() && !known->isRemoved && isSame(known->tool, tool)) {
            continue;
        }
        if (known != assets_.end()) {
            assets_.erase(known);
        }
        assets_.insert(assets_.begin(), {tool, now, id_of(tool)});
        observations_.add(model_.asset_changed(), id_of(tool), now);
    }
    for (Asset &asset : assets_) {
        if (!asset.isRemoved && !present.contains(asset.tool.toolno)) {
            asset.isRemoved = true;
            asset.at = now;
            observations_.add(model_.asset_removed(), asset.id, now);
        }
    }
    if (assets_.size() > MOST_ASSETS) {
        assets_.resize(MOST_ASSETS);
    }
}

std::string Agent::current_document(const std::optional<Filter> &filter, std::optional<Sequence> at,
                                    TimeMs now) const {
    std::vector<Observation> state = at.has_value() ? observations_.at(*at) : observations_.current();
    std::erase_if(state, [&filter](const Observation &one) {
        return filter.has_value() && !filter->contains(one.item);
    });
    return streams_document(facts(), model_, span(), state, now);
}

std::string Agent::sample_document(const std::optional<Filter> &filter, Sequence &from, std::int64_t count,
                                   TimeMs now) const {
    const auto most = static_cast<std::size_t>(std::abs(count));
    std::vector<Observation> found;
    const auto take = [&](Sequence sequence) {
        const Observation &one = observations_.get(sequence);
        if (!filter.has_value() || filter->contains(one.item)) {
            found.push_back(one);
        }
    };
    Span span = this->span();
    if (count < 0) {
        Sequence at = std::min(from, observations_.last());
        for (; at >= observations_.first() && found.size() < most; --at) {
            take(at);
        }
        std::ranges::reverse(found);
        from = at;
        span.next = std::max(at, observations_.first());
    } else {
        Sequence at = std::max(from, observations_.first());
        for (; at <= observations_.last() && found.size() < most; ++at) {
            take(at);
        }
        from = span.next = at;
    }
    return streams_document(facts(), model_, span, found, now);
}

Agent::Outcome<std::optional<Filter>> Agent::filter(const Query &query) const {
    const std::string path = text_of(query, "path");
    if (!query.contains("path")) {
        return std::optional<Filter>();
    }
    auto found = select(model_, path);
    if (!found.has_value()) {
        return std::unexpected(Failure{400, "INVALID_PATH", fmt::format("'{}' is not a valid XPath.", path)});
    }
    if (found->empty()) {
        return std::unexpected(
            Failure{400, "INVALID_PATH", fmt::format("The path '{}' selects no data item.", path)});
    }
    return found;
}

namespace {

/// A whole number in a request within a range; `preset` if it is missing.
std::expected<std::int64_t, std::string> whole(const Query &query, const char *name, std::int64_t preset,
                                               std::int64_t low, std::int64_t high) {
    const auto found = query.find(name);
    if (found == query.end()) {
        return preset;
    }
    const auto number = parse_int(found->second);
    if (!number.has_value() || *number < low || *number > high) {
        return std::unexpected(fmt::format("'{}' must be a whole number from {} to {}, not '{}'.", name, low,
                                           high, found->second));
    }
    return *number;
}

}  // namespace

Agent::Outcome<std::optional<Stream>> Agent::stream(const Query &query, double now_s) const {
    if (!query.contains("interval")) {
        return std::optional<Stream>();
    }
    const auto interval = whole(query, "interval", 0, 0, MOST_MS),
               heartbeat = whole(query, "heartbeat", 10'000, 1, MOST_MS);
    if (!interval.has_value() || !heartbeat.has_value()) {
        return std::unexpected(
            Failure{400, "OUT_OF_RANGE", interval.has_value() ? heartbeat.error() : interval.error()});
    }
    Stream stream;
    stream.interval_s = static_cast<double>(*interval) / MS_PER_S;
    stream.heartbeat_s = static_cast<double>(*heartbeat) / MS_PER_S;
    stream.instance = instance_;
    stream.sent_s = now_s - std::max(stream.heartbeat_s, stream.interval_s);
    return std::optional(stream);
}

Agent::Outcome<std::variant<Answer, Stream>> Agent::current(const Query &query, TimeMs now,
                                                            double now_s) const {
    auto items = filter(query);
    auto requested = stream(query, now_s);
    const auto at = whole(query, "at", 0, static_cast<std::int64_t>(observations_.first()),
                          static_cast<std::int64_t>(observations_.last()));
    if (!items.has_value() || !requested.has_value()) {
        return std::unexpected(items.has_value() ? requested.error() : items.error());
    }
    if (!at.has_value()) {
        return std::unexpected(Failure{404, "OUT_OF_RANGE", at.error()});
    }
    if (requested->has_value()) {
        if (query.contains("at")) {
            return std::unexpected(
                Failure{400, "INVALID_REQUEST", "'at' cannot be used together with 'interval'."});
        }
        (*requested)->filter = *items;
        (*requested)->isCurrent = true;
        return **requested;
    }
    const auto sequence =
        query.contains("at") ? std::optional<Sequence>(static_cast<Sequence>(*at)) : std::nullopt;
    return Answer{200, current_document(*items, sequence, now)};
}

Agent::Outcome<std::variant<Answer, Stream>> Agent::sample(const Query &query, TimeMs now,
                                                           double now_s) const {
    auto items = filter(query);
    auto requested = stream(query, now_s);
    if (!items.has_value() || !requested.has_value()) {
        return std::unexpected(items.has_value() ? requested.error() : items.error());
    }
    const auto most = static_cast<std::int64_t>(observations_.capacity());
    const auto count = whole(query, "count", PRESET_COUNT, -most, most);
    if (!count.has_value() || *count == 0) {
        return std::unexpected(Failure{
            404, "OUT_OF_RANGE", count.has_value() ? std::string("'count' must not be 0.") : count.error()});
    }
    const bool isBackwards = *count < 0;
    const auto first = static_cast<std::int64_t>(observations_.first());
    const auto next = static_cast<std::int64_t>(observations_.next());
    const auto from = whole(query, "from", isBackwards ? next - 1 : first, first, next);
    if (!from.has_value()) {
        return std::unexpected(Failure{404, "OUT_OF_RANGE", from.error()});
    }
    auto sequence = static_cast<Sequence>(*from);
    if (!requested->has_value()) {
        return Answer{200, sample_document(*items, sequence, *count, now)};
    }
    if (isBackwards) {
        return std::unexpected(
            Failure{400, "OUT_OF_RANGE", "'count' must not be negative together with 'interval'."});
    }
    (*requested)->filter = *items;
    (*requested)->next = sequence;
    (*requested)->count = static_cast<std::size_t>(*count);
    return **requested;
}

Agent::Outcome<std::variant<Answer, Stream>> Agent::assets(const std::string &ids, const Query &query,
                                                           TimeMs now) const {
    std::vector<Asset> found;
    if (!ids.empty()) {
        std::size_t begin = 0;
        while (begin <= ids.size()) {
            const std::size_t end = std::min(ids.find(';', begin), ids.size());
            const std::string id = ids.substr(begin, end - begin);
            const auto asset = std::ranges::find(assets_, id, &Asset::id);
            if (asset == assets_.end()) {
                return std::unexpected(
                    Failure{404, "ASSET_NOT_FOUND", fmt::format("There is no asset '{}'.", id)});
            }
            found.push_back(*asset);
            begin = end + 1;
        }
        return Answer{200, assets_document(facts(), settings_.uuid, found, units_per_mm_, now)};
    }
    const auto count = whole(query, "count", PRESET_COUNT, 1, static_cast<std::int64_t>(MOST_ASSETS));
    if (!count.has_value()) {
        return std::unexpected(Failure{400, "OUT_OF_RANGE", count.error()});
    }
    const std::string type = text_of(query, "type");
    const bool isAll = text_of(query, "removed") == "true";
    for (const Asset &asset : assets_) {
        const bool isWanted = (type.empty() || type == "CuttingTool") && (isAll || !asset.isRemoved);
        if (isWanted && found.size() < static_cast<std::size_t>(*count)) {
            found.push_back(asset);
        }
    }
    return Answer{200, assets_document(facts(), settings_.uuid, found, units_per_mm_, now)};
}

Agent::Outcome<std::variant<Answer, Stream>> Agent::find_answer(std::string path, const Query &query,
                                                                TimeMs now, double now_s) const {
    while (path.ends_with('/')) {
        path.pop_back();
    }
    const auto isRequest = [](const std::string &word) {
        constexpr std::array<const char *, 5> REQUESTS{"probe", "current", "sample", "asset", "assets"};
        return std::ranges::find(REQUESTS, word) != REQUESTS.end();
    };
    std::string request = path.empty() ? "probe" : path.substr(1), rest;
    if (const std::size_t slash = request.find('/'); slash != std::string::npos) {
        rest = request.substr(slash + 1);
        request.resize(slash);
    }
    if (!isRequest(request)) {
        if (request != settings_.device && request != settings_.uuid) {
            return std::unexpected(
                Failure{404, "NO_DEVICE", fmt::format("There is no device '{}'.", request)});
        }
        request = rest.empty() ? "probe" : rest;
        rest.clear();
    }
    const std::string device = text_of(query, "device");
    if (!device.empty() && device != settings_.device && device != settings_.uuid) {
        return std::unexpected(Failure{404, "NO_DEVICE", fmt::format("There is no device '{}'.", device)});
    }
    const bool isOfAssets = request == "asset" || request == "assets";
    if (!isRequest(request) || (!rest.empty() && !isOfAssets)) {
        return std::unexpected(
            Failure{404, "INVALID_REQUEST", "Use /probe, /current, /sample, /assets or /asset/ID."});
    }
    if (isOfAssets) {
        return assets(rest, query, now);
    }
    return request == "probe"     ? Answer{200, devices_document(facts(), model_, now)}
           : request == "current" ? current(query, now, now_s)
                                  : sample(query, now, now_s);
}

std::variant<Answer, Stream> Agent::answer(const std::string &path, const Query &query, TimeMs now,
                                           double now_s) const {
    const std::lock_guard lock(mutex_);
    auto found = find_answer(path, query, now, now_s);
    if (!found.has_value()) {
        const Failure &failure = found.error();
        return Answer{failure.status, error_document(facts(), failure.code, failure.text, now)};
    }
    return std::move(*found);
}

std::optional<std::string> Agent::next(Stream &stream, TimeMs now, double now_s) const {
    const std::lock_guard lock(mutex_);
    const bool isLost =
        stream.instance != instance_ || (!stream.isCurrent && stream.next < observations_.first());
    if (isLost && !stream.isEnded) {
        stream.isEnded = true;
        return error_document(facts(), "OUT_OF_RANGE",
                              stream.instance != instance_ ? "The device has changed: request a probe again."
                                                           : "The client was too slow for the buffer.",
                              now);
    }
    const double waited_s = now_s - stream.sent_s;
    const bool isNew = stream.isCurrent || stream.next < observations_.next();
    // If there is nothing new, an empty document shows that the agent is alive.
    if (stream.isEnded || waited_s < stream.interval_s || (!isNew && waited_s < stream.heartbeat_s)) {
        return std::nullopt;
    }
    if (stream.isCurrent) {
        stream.sent_s = now_s;
        return current_document(stream.filter, std::nullopt, now);
    }
    const bool isHeartbeat = waited_s >= stream.heartbeat_s;
    Sequence at = stream.next;
    std::string document = sample_document(stream.filter, at, static_cast<std::int64_t>(stream.count), now);
    stream.next = at;
    const bool isEmpty = document.find("<ComponentStream") == std::string::npos;
    if (isEmpty && !isHeartbeat) {  // all observations were of other items
        return std::nullopt;
    }
    stream.sent_s = now_s;
    return document;
}

}  // namespace mw::publish::mtconnect
