// SPDX-License-Identifier: GPL-2.0-or-later
// Implemented with libxml2, which only this file includes.
#include <libxml/parser.h>
#include <libxml/xpath.h>

#include <algorithm>
#include <memory>

#include "clients/publish/mtconnect/device_model.hh"

namespace mw::publish::mtconnect {
namespace {

/// Maximum number of steps for an expression from a client.
constexpr unsigned long MOST_STEPS = 200'000;
constexpr std::size_t LONGEST_PATH = 1000;

struct FreeDocument {
    void operator()(xmlDoc *document) const { xmlFreeDoc(document); }
};
struct FreeContext {
    void operator()(xmlXPathContext *context) const { xmlXPathFreeContext(context); }
};
struct FreeObject {
    void operator()(xmlXPathObject *object) const { xmlXPathFreeObject(object); }
};
struct FreeText {
    void operator()(xmlChar *text) const { xmlFree(text); }
};

void be_silent(void *, const xmlError *) {}

void collect(xmlNode *node, const DeviceModel &model, Filter &into) {
    if (node->type != XML_ELEMENT_NODE) {
        return;
    }
    const std::unique_ptr<xmlChar, FreeText> id(xmlGetProp(node, reinterpret_cast<const xmlChar *>("id")));
    if (id != nullptr && std::string_view(reinterpret_cast<const char *>(node->name)) == "DataItem") {
        const auto found =
            std::ranges::find(model.items(), reinterpret_cast<const char *>(id.get()), &DataItem::id);
        if (found != model.items().end()) {
            into.insert(static_cast<ItemId>(found - model.items().begin()));
        }
    }
    for (xmlNode *child = node->children; child != nullptr; child = child->next) {
        collect(child, model, into);
    }
}

}  // namespace

std::optional<Filter> select(const DeviceModel &model, const std::string &path) {
    if (path.size() > LONGEST_PATH) {
        return std::nullopt;
    }
    // Without a namespace, because clients write element names of MTConnect without one.
    const std::string text = "<MTConnectDevices><Devices>" + model.xml() + "</Devices></MTConnectDevices>";
    const std::unique_ptr<xmlDoc, FreeDocument> document(
        xmlReadMemory(text.data(), static_cast<int>(text.size()), "probe.xml", nullptr, XML_PARSE_NONET));
    const std::unique_ptr<xmlXPathContext, FreeContext> context(xmlXPathNewContext(document.get()));
    if (context == nullptr) {
        return std::nullopt;
    }
    context->error = reinterpret_cast<xmlStructuredErrorFunc>(be_silent);
    context->opLimit = MOST_STEPS;
    const std::unique_ptr<xmlXPathObject, FreeObject> found(
        xmlXPathEvalExpression(reinterpret_cast<const xmlChar *>(path.c_str()), context.get()));
    if (found == nullptr || found->type != XPATH_NODESET) {
        return std::nullopt;
    }
    Filter filter;
    for (int i = 0; found->nodesetval != nullptr && i < found->nodesetval->nodeNr; ++i) {
        collect(found->nodesetval->nodeTab[i], model, filter);
    }
    return filter;
}

}  // namespace mw::publish::mtconnect
