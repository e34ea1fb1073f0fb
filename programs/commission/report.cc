// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/commission/report.hh"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "base/text.hh"
#include "machine/commissioning/guide.hh"

namespace mw::programs {
namespace {

using commissioning::Fault;

constexpr std::array CHECKLIST{
    "The emergency stop switches off all drives and the spindle.",
    "Each axis stops at its soft limits.",
    "The spindle does not start with an open guard.",
    "The first program runs in the air without a message.",
    "A test piece has the sizes of its drawing.",
    "The machine's files are stored in a backup.",
};

constexpr std::string_view STYLE =
    "body{font:11pt sans-serif;margin:2cm;max-width:18cm}table{border-collapse:collapse;width:100%}"
    "td,th{border:1px solid #888;padding:3px 6px;text-align:left;vertical-align:top}"
    "tr{break-inside:avoid}";

struct Line {
    std::string title, result, values, date;
};

/// The line of a step: its finding, or that it was not done.
Line line_of(const commissioning::Step &step, const ReportFacts &facts) {
    const auto found = std::ranges::find(facts.record, step.title, &Recorded::title);
    if (found == facts.record.end()) {
        return {step.title, "not done", "", ""};
    }
    if (!isValid(*found, facts.answers)) {
        return {step.title, "to be repeated: its answers were changed", "", found->date};
    }
    const commissioning::Finding &finding = found->finding;
    std::string values;
    for (const commissioning::Value &value : finding.values) {
        values += fmt::format("{}{} {:.6g}{}{}", values.empty() ? "" : "; ", value.name, value.number,
                              value.unit.empty() ? "" : " ", value.unit);
    }
    for (const auto &[key, value] : finding.after) {
        values += fmt::format("{}{} = {}", values.empty() ? "" : "; ", key, value);
    }
    const std::string result =
        finding.fault == Fault::NONE ? "passed" : "FAULT: " + std::string(fault_name(finding.fault));
    return {step.title, result + (finding.detail.empty() ? "" : " (" + finding.detail + ")"), values,
            found->date};
}

std::vector<Line> lines_of(const ReportFacts &facts) {
    std::vector<Line> lines;
    for (const commissioning::Step &step : commissioning::steps_of(setup::plan_of(facts.answers).plan)) {
        lines.push_back(line_of(step, facts));
    }
    return lines;
}

bool isPassed(const Line &line) {
    return line.result.starts_with("passed");
}

bool isReady(const std::vector<Line> &lines) {
    return std::ranges::all_of(lines, isPassed);
}

std::string name_of(const ReportFacts &facts) {
    return setup::answer_of(setup::questions(facts.answers), facts.answers, "name");
}

std::string escaped(std::string_view text) {
    std::string all;
    for (const char c : text) {
        switch (c) {
        case '&': all += "&amp;"; break;
        case '<': all += "&lt;"; break;
        case '>': all += "&gt;"; break;
        case '"': all += "&quot;"; break;
        default: all += c;
        }
    }
    return all;
}

}  // namespace

std::string report_text(const ReportFacts &facts) {
    const auto lines = lines_of(facts);
    std::string text =
        fmt::format("{}\nReport of {}, Millwright {}\nFolder: {}\nState: {}\n\n", name_of(facts), facts.date,
                    facts.version, facts.folder, isReady(lines) ? "ready" : "NOT READY");
    for (const Line &line : lines) {
        text += fmt::format("{:<28} {:<10} {}\n", line.title, line.result, line.date);
        if (!line.values.empty()) {
            text += "    " + line.values + "\n";
        }
    }
    text += "\nChecklist for acceptance\n";
    for (const char *item : CHECKLIST) {
        text += fmt::format("[ ] {}\n", item);
    }
    return text + "\nName, date, signature: ______________________________\n";
}

std::string report_html(const ReportFacts &facts) {
    const auto lines = lines_of(facts);
    std::string html = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" +
                       escaped(name_of(facts)) + "</title>\n<style>";
    html += STYLE;
    html += fmt::format(
        "</style></head><body>\n<h1>{}</h1>\n<p>Report of {}, Millwright {}<br>Folder: {}<br>State: "
        "<strong>{}</strong></p>\n<h2>Steps</h2>\n"
        "<table><tr><th>Step</th><th>Result</th><th>Values</th><th>Date (UTC)</th></tr>\n",
        escaped(name_of(facts)), escaped(facts.date), escaped(facts.version), escaped(facts.folder),
        isReady(lines) ? "ready" : "NOT READY");
    for (const Line &line : lines) {
        html += fmt::format("<tr><td>{}</td><td>{}{}{}</td><td>{}</td><td>{}</td></tr>\n",
                            escaped(line.title), isPassed(line) ? "" : "<strong>", escaped(line.result),
                            isPassed(line) ? "" : "</strong>", escaped(line.values), escaped(line.date));
    }
    html += "</table>\n<h2>Settings</h2>\n<table><tr><th>Setting</th><th>Value</th></tr>\n";
    const auto asked = setup::questions(facts.answers);
    for (const setup::Question &question : asked) {
        html += fmt::format("<tr><td>{}</td><td>{} {}</td></tr>\n", escaped(question.text),
                            escaped(setup::answer_of(asked, facts.answers, question.key)),
                            escaped(question.unit));
    }
    html += "</table>\n<h2>Checklist for acceptance</h2>\n<table>\n";
    for (const char *item : CHECKLIST) {
        html += fmt::format("<tr><td>&#9744;</td><td>{}</td></tr>\n", escaped(item));
    }
    return html + "</table>\n<h2>Signatures</h2>\n<table "
                  "style=\"height:3cm\"><tr><td>Name</td><td>Date</td><td>Signature</td></tr>"
                  "<tr><td></td><td></td><td></td></tr></table>\n</body></html>\n";
}

}  // namespace mw::programs
