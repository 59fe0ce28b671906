// SPDX-License-Identifier: GPL-3.0-or-later
#include "report.h"

namespace glimmer {

Report make_report(glimmer_render *render, double load_seconds, double build_seconds,
                   const std::vector<std::string> &left_out) {
    const char *text = nullptr;
    check(glimmer_render_report(render, &text), "report");
    Report report = Report::parse(text, nullptr, false);
    if (!report.is_object())
        throw ResultError("report: the engine's report is not JSON; please report this");
    Report &seconds = report["seconds"];
    seconds["load"] = load_seconds;
    if (!seconds.contains("build") || seconds["build"] == 0)
        seconds["build"] = build_seconds;
    Report all = Report::array();
    for (const std::string &line : left_out)
        all.push_back(line);
    if (report.contains("left_out"))
        all.insert(all.end(), report["left_out"].begin(), report["left_out"].end());
    report["left_out"] = all;
    return report;
}

std::vector<std::string> report_texts(const Report &report, const char *key) {
    std::vector<std::string> texts;
    if (report.contains(key))
        for (const auto &text : report[key])
            texts.push_back(text.get<std::string>());
    return texts;
}

} // namespace glimmer
