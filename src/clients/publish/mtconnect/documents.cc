// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/mtconnect/documents.hh"

#include <cmath>

#include <fmt/format.h>

#include "clients/publish/mtconnect/forms.hh"

namespace mw::publish::mtconnect {
namespace {

constexpr const char *VERSION = "2.2";

/// The root element with its content.
std::string document(const char *name, const std::string &content) {
    return fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                       "<MTConnect{0} xmlns=\"urn:mtconnect.org:MTConnect{0}:{1}\" "
                       "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
                       "xsi:schemaLocation=\"urn:mtconnect.org:MTConnect{0}:{1} "
                       "http://schemas.mtconnect.org/schemas/MTConnect{0}_{1}.xsd\">{2}</MTConnect{0}>\n",
                       name, VERSION, content);
}

/// The header without its end, because documents add attributes.
std::string header(const AgentFacts &facts, TimeMs now) {
    return fmt::format("<Header creationTime=\"{}\" sender=\"{}\" instanceId=\"{}\" version=\"{}.0.0\"",
                       time_text(now), escaped(facts.sender), facts.instance, VERSION);
}

std::string model_time(const AgentFacts &facts) {
    return fmt::format(" deviceModelChangeTime=\"{}\"", time_text(facts.model_changed));
}

std::string sub_type(const DataItem &item) {
    return item.sub_type.empty() ? "" : fmt::format(" subType=\"{}\"", item.sub_type);
}

std::string condition(const DataItem &item, const Observation &one, const std::string &place) {
    const bool isUnknown = one.value == UNAVAILABLE;
    const char *const level = isUnknown ? "Unavailable" : one.value.empty() ? "Normal" : "Fault";
    const std::string head = fmt::format("<{} {} type=\"{}\"", level, place, item.type);
    return isUnknown || one.value.empty() ? head + "/>"
                                          : fmt::format("{}>{}</{}>", head, escaped(one.value), level);
}

std::string observation(const DataItem &item, const Observation &one) {
    const std::string place = fmt::format("dataItemId=\"{}\" timestamp=\"{}\" sequence=\"{}\"", item.id,
                                          time_text(one.at), one.sequence);
    if (item.category == Category::CONDITION) {
        return condition(item, one, place);
    }
    const bool isOfAssets = item.type == "ASSET_CHANGED" || item.type == "ASSET_REMOVED";
    const std::string name = item.element();
    return fmt::format("<{0} {1}{2}{3}>{4}</{0}>", name, place, sub_type(item),
                       isOfAssets ? " assetType=\"CuttingTool\"" : "", escaped(one.value));
}

std::string component_stream(const DeviceModel &model, std::size_t component,
                             const std::vector<Observation> &observations) {
    std::string parts[3];
    for (const Observation &one : observations) {
        const DataItem &item = model.items()[one.item];
        if (item.component == component) {
            parts[static_cast<std::size_t>(item.category)] += observation(item, one);
        }
    }
    const auto within = [](const char *name, const std::string &text) {
        return text.empty() ? std::string() : fmt::format("<{0}>{1}</{0}>", name, text);
    };
    const std::string inner =
        within("Samples", parts[0]) + within("Events", parts[1]) + within("Condition", parts[2]);
    if (inner.empty()) {
        return "";
    }
    const ModelComponent &one = model.components()[component];
    const std::string name = one.name.empty() ? "" : fmt::format(" name=\"{}\"", escaped(one.name));
    return fmt::format("<ComponentStream component=\"{}\" componentId=\"{}\"{}>{}</ComponentStream>",
                       one.element, one.id, name, inner);
}

std::string measurement(const char *name, const char *code, double length, double units_per_mm) {
    constexpr double TINY = 1e-9;
    if (std::abs(length) < TINY || !std::isfinite(length)) {
        return "";
    }
    return fmt::format("<{0} code=\"{1}\" units=\"MILLIMETER\">{2:.6f}</{0}>", name, code,
                       length / units_per_mm);
}

std::string tool_xml(const Asset &asset, const std::string &device, double units_per_mm) {
    const messages::ToolRecord &tool = asset.tool;
    std::string text =
        fmt::format("<CuttingTool assetId=\"{0}\" serialNumber=\"{1}\" toolId=\"{1}\" timestamp=\"{2}\" "
                    "deviceUuid=\"{3}\"{4}>",
                    escaped(asset.id), tool.toolno, time_text(asset.at), escaped(device),
                    asset.isRemoved ? " removed=\"true\"" : "");
    const std::string comment = escaped(clean_text(tool.comment));
    text += comment.empty() ? "" : fmt::format("<Description>{}</Description>", comment);
    text += fmt::format("<CuttingToolLifeCycle><CutterStatus><Status>{}</Status></CutterStatus>"
                        "<ProgramToolNumber>{}</ProgramToolNumber>",
                        asset.isRemoved ? "UNAVAILABLE" : "AVAILABLE", tool.toolno);
    text += tool.pocketno > 0 ? fmt::format("<Location type=\"POT\">{}</Location>", tool.pocketno) : "";
    const std::string measurements = measurement("CuttingDiameterMax", "DC", tool.diameter, units_per_mm) +
                                     measurement("FunctionalLength", "LF", tool.offset.z(), units_per_mm);
    text += measurements.empty() ? "" : "<Measurements>" + measurements + "</Measurements>";
    return text + "</CuttingToolLifeCycle></CuttingTool>";
}

}  // namespace

std::string devices_document(const AgentFacts &facts, const DeviceModel &model, TimeMs now) {
    return document("Devices",
                    header(facts, now) +
                        fmt::format(" bufferSize=\"{}\" assetBufferSize=\"{}\" assetCount=\"{}\"{}/>",
                                    facts.buffer, facts.most_assets, facts.assets, model_time(facts)) +
                        "<Devices>" + model.xml() + "</Devices>");
}

std::string streams_document(const AgentFacts &facts, const DeviceModel &model, const Span &span,
                             const std::vector<Observation> &observations, TimeMs now) {
    std::string streams;
    for (std::size_t i = 0; i < model.components().size() && !observations.empty(); ++i) {
        streams += component_stream(model, i, observations);
    }
    return document(
        "Streams",
        header(facts, now) +
            fmt::format(" bufferSize=\"{}\" nextSequence=\"{}\" firstSequence=\"{}\" lastSequence=\"{}\"{}/>",
                        facts.buffer, span.next, span.first, span.last, model_time(facts)) +
            fmt::format("<Streams><DeviceStream name=\"{}\" uuid=\"{}\">{}</DeviceStream></Streams>",
                        escaped(model.name()), escaped(model.uuid()), streams));
}

std::string assets_document(const AgentFacts &facts, const std::string &device_uuid,
                            const std::vector<Asset> &assets, double units_per_mm, TimeMs now) {
    std::string list;
    for (const Asset &asset : assets) {
        list += tool_xml(asset, device_uuid, units_per_mm > 0 ? units_per_mm : 1);
    }
    return document("Assets", header(facts, now) +
                                  fmt::format(" assetBufferSize=\"{}\" assetCount=\"{}\"{}/>",
                                              facts.most_assets, facts.assets, model_time(facts)) +
                                  "<Assets>" + list + "</Assets>");
}

std::string error_document(const AgentFacts &facts, std::string_view code, std::string_view text,
                           TimeMs now) {
    return document("Error", header(facts, now) + fmt::format(" bufferSize=\"{}\"/>", facts.buffer) +
                                 fmt::format("<Errors><Error errorCode=\"{}\">{}</Error></Errors>", code,
                                             escaped(clean_text(text))));
}

}  // namespace mw::publish::mtconnect
