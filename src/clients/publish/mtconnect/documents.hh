// SPDX-License-Identifier: GPL-2.0-or-later
// The documents of MTConnect 2.2.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "clients/publish/mtconnect/device_model.hh"
#include "clients/publish/mtconnect/observations.hh"
#include "messages/declarations/status.hh"

namespace mw::publish::mtconnect {

/// Data about the agent in every document.
struct AgentFacts {
    std::string sender;          ///< name of this computer
    std::uint64_t instance = 1;  ///< changes when the sequence numbers start again
    TimeMs model_changed = 0;
    std::size_t buffer = 0;  ///< number of stored observations
    std::size_t assets = 0, most_assets = 0;
};

/// Sequence numbers of a document of observations.
struct Span {
    Sequence first = 0, last = 0, next = 0;
};

struct Asset {
    messages::ToolRecord tool;
    TimeMs at = 0;
    std::string id;
    bool isRemoved = false;
};

std::string devices_document(const AgentFacts &facts, const DeviceModel &model, TimeMs now);
/// Document of observations in any order.
std::string streams_document(const AgentFacts &facts, const DeviceModel &model, const Span &span,
                             const std::vector<Observation> &observations, TimeMs now);
/// Tools as assets CuttingTool. `units_per_mm`: machine units per millimetre.
std::string assets_document(const AgentFacts &facts, const std::string &device_uuid,
                            const std::vector<Asset> &assets, double units_per_mm, TimeMs now);
std::string error_document(const AgentFacts &facts, std::string_view code, std::string_view text, TimeMs now);

}  // namespace mw::publish::mtconnect
