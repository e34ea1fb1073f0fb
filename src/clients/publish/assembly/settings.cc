// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/assembly/settings.hh"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/ini/ini_reader.hh"
#include "base/text.hh"
#include "clients/publish/assembly/ini_keys.hh"
#include "clients/publish/assembly/link_section.hh"

namespace mw::publish {
namespace {

constexpr const char *SECTION = "PUBLISH";

template <std::size_t N>
struct KeyName {
    char text[N]{};
    consteval KeyName(const char (&name)[N]) { std::copy_n(name, N, text); }
};
template <KeyName NAME>
inline constexpr const ini::IniKey &KEY = ini::row_of(PUBLISH_KEYS, SECTION, NAME.text);

/// Reads the section and reports problems to the sink.
class SectionReader {
  public:
    SectionReader(const ini::IniFile &file, const Surroundings &around, diagnostics::Sink &sink)
        : file_(file), around_(around), reader_(file, sink), sink_(reader_.sink()) {
        reader_.declare(PUBLISH_KEYS);
    }

    Settings read() {
        Settings settings;
        read_node(settings.node);
        settings.interval_s = reader_.real(KEY<"INTERVAL">);
        read_deadbands(settings.deadbands);
        read_link(settings);
        read_store(settings);
        read_offers(settings);
        read_agent(settings);
        const bool hasBroker = reader_.find(KEY<"BROKER">) != nullptr;
        if (!hasBroker && !settings.agent_port.has_value()) {
            sink_.error("Nothing to publish: [PUBLISH] sets neither BROKER nor MTCONNECT_PORT.",
                        file_.place_of_section(SECTION));
        }
        reader_.report_unknown(false);
        return settings;
    }

  private:
    SourcePlace place(const ini::IniKey &key) const {
        const ini::IniEntry *const entry = reader_.find(key);
        return entry == nullptr ? file_.place_of_section(SECTION) : entry->place;
    }
    std::string topic_part(const ini::IniKey &key, const std::string &preset) {
        std::string text = reader_.text(key);
        text = text.empty() ? preset : text;
        if (const std::string wrong = check_topic_part(text); !wrong.empty()) {
            sink_.error(
                fmt::format("[PUBLISH]{} = '{}' cannot be part of a topic: {}.", key.name, text, wrong),
                place(key));
        }
        return text;
    }
    void read_node(NodeSettings &node) {
        const ini::IniEntry *const machine = file_.find("EMC", "MACHINE");
        node.group = topic_part(KEY<"GROUP">, "millwright");
        node.node = topic_part(KEY<"NODE">, around_.host);
        node.device = topic_part(KEY<"DEVICE">, machine == nullptr ? "machine" : machine->value);
        node.isTyped = reader_.boolean(KEY<"DATA_TYPES">);
        if (reader_.find(KEY<"PRIMARY_HOST">) != nullptr) {
            node.primary_host = topic_part(KEY<"PRIMARY_HOST">, "");
        }
    }
    void read_deadbands(Deadbands &deadbands) {
        for (const ini::IniEntry *entry : reader_.list(KEY<"DEADBAND">)) {
            const std::size_t blank = entry->value.rfind(' ');
            const std::string name(trim(std::string_view(entry->value).substr(0, blank)));
            const auto value = blank == std::string::npos
                                   ? std::nullopt
                                   : parse_double(std::string_view(entry->value).substr(blank + 1));
            std::vector<std::string> known;
            for (const Row &row : rows()) {
                known.emplace_back(row.metric);
            }
            if (!value.has_value() || *value < 0) {
                sink_.error("DEADBAND needs the name of a metric and a number that is not negative.",
                            entry->place, "DEADBAND = Axes/#/Position 0.01");
            } else if (std::ranges::find(known, name) == known.end()) {
                const std::string near = nearest_name(name, known);
                sink_.error(fmt::format("No metric has the name '{}'.", name), entry->place,
                            near.empty() ? "see the reference page of published values" : near);
            } else {
                deadbands[name] = *value;
            }
        }
    }
    void read_link(Settings &settings) {
        LinkSettings link = read_link_section(
            {file_, reader_, sink_}, {KEY<"BROKER">, KEY<"TLS">, KEY<"CA_FILE">, KEY<"CERTIFICATE">,
                                      KEY<"KEY">, KEY<"USER">, KEY<"PASSWORD_FILE">, KEY<"KEEPALIVE">});
        link.client_id = fmt::format("{}/{}", settings.node.group, settings.node.node);
        link.not_delivered_topic = fmt::format("spBv1.0/{}/DCMD/{}/{}", settings.node.group,
                                               settings.node.node, settings.node.device);
        if (!link.brokers.empty()) {
            settings.node.brokers = link.brokers.size();
            settings.link = std::move(link);
        }
    }
    void read_store(Settings &settings) {
        constexpr double BYTES_PER_MB = 1e6;
        settings.store_limits.bytes =
            static_cast<std::uint64_t>(reader_.real(KEY<"STORE_SIZE">) * BYTES_PER_MB);
        settings.store_limits.segment_bytes =
            std::clamp<std::uint64_t>(settings.store_limits.bytes / 16, 64UL << 10U, 4UL << 20U);
        const std::string folder = reader_.text(KEY<"STORE">);
        if (!folder.empty()) {
            settings.store = file_.resolve_path(folder);
        } else if (!around_.state_folder.empty()) {
            settings.store =
                fmt::format("{}/millwright/publish/{}", around_.state_folder, settings.node.device);
        } else if (settings.link.has_value()) {
            sink_.error("No home folder found to store values until the broker answers.", place(KEY<"STORE">),
                        "set [PUBLISH]STORE");
        }
    }
    void read_offers(Settings &settings) {
        if (!reader_.boolean(KEY<"OFFERS">)) {
            return;
        }
        const NodeSettings &node = settings.node;
        if (!settings.link.has_value() || node.primary_host.empty()) {
            sink_.error("OFFERS of [PUBLISH] needs BROKER and PRIMARY_HOST.", place(KEY<"OFFERS">));
            return;
        }
        settings.offers = OfferSettings{.host = node.primary_host,
                                        .group = node.group,
                                        .node = node.node,
                                        .device = node.device,
                                        .brokers = node.brokers};
        if (const ini::IniEntry *const tools = file_.find("EMCIO", "TOOL_TABLE"); tools != nullptr) {
            settings.offers->copies.push_back({"tools", file_.resolve_path(tools->value)});
        }
    }
    void read_agent(Settings &settings) {
        settings.agent.device = settings.node.device;
        settings.agent.sender = around_.host;
        settings.agent.buffer = static_cast<std::size_t>(reader_.integer(KEY<"MTCONNECT_BUFFER">));
        const std::string uuid = reader_.text(KEY<"UUID">);
        settings.agent.uuid =
            !uuid.empty() ? uuid : fmt::format("{}.{}", around_.machine_id, settings.node.device);
        const std::int64_t port = reader_.integer(KEY<"MTCONNECT_PORT">);
        AgentPort agent{static_cast<int>(port), reader_.text(KEY<"MTCONNECT_LISTEN">), {}};
        for (const ini::IniEntry *entry : reader_.list(KEY<"MTCONNECT_NAME">)) {
            agent.names.push_back(to_lower(entry->value));
        }
        if (port >= 0) {
            settings.agent_port = std::move(agent);
        }
    }

    const ini::IniFile &file_;
    const Surroundings &around_;
    ini::IniReader reader_;
    diagnostics::Sink &sink_;
};

}  // namespace

Surroundings this_computer() {
    Surroundings found;
    std::array<char, 256> host{};
    found.host =
        ::gethostname(host.data(), host.size() - 1) == 0 && host[0] != '\0' ? host.data() : "localhost";
    constexpr std::size_t MOST = 100;
    const auto id = read_file("/etc/machine-id", MOST);
    found.machine_id = id.has_value() && !trim(*id).empty() ? std::string(trim(*id)) : found.host;
    const char *const state = std::getenv("XDG_STATE_HOME"), *const home = std::getenv("HOME");
    if (state != nullptr && *state != '\0') {
        found.state_folder = state;
    } else if (home != nullptr && *home != '\0') {
        found.state_folder = std::string(home) + "/.local/state";
    }
    return found;
}

std::optional<Settings> read_settings(const ini::IniFile &file, const Surroundings &around,
                                      diagnostics::Sink &sink) {
    const int before = sink.count_errors();
    if (!file.hasSection(SECTION)) {
        sink.error(fmt::format("{} has no section [PUBLISH] with the broker and the values to publish.",
                               file.path()));
        return std::nullopt;
    }
    Settings settings = SectionReader(file, around, sink).read();
    return sink.count_errors() == before ? std::optional(std::move(settings)) : std::nullopt;
}

}  // namespace mw::publish
