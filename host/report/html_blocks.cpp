#include "host/report/html_blocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/report/numeric_column.hpp"
#include "host/report/series_colour.hpp"
#include "host/report/text_format.hpp"

namespace host::html {

namespace {

const char* tone_class(Tone tone) {
  switch (tone) {
    case Tone::good:
      return "good";
    case Tone::attention:
      return "attention";
    case Tone::bad:
      return "bad";
    case Tone::neutral:
      break;
  }
  return "neutral";
}

std::string element(const char* name, std::string_view text) {
  return text.empty() ? "" : fmt::format("<{0}>{1}</{0}>\n", name, escape_html(text));
}

std::string caption_of(std::string_view title, std::string_view caption) {
  return fmt::format("<figcaption>{}{}</figcaption>\n", element("strong", title), element("span", caption));
}

std::string reference_mark(const BarChart& chart, double longest) {
  if (!chart.reference) return "";
  return fmt::format("<i class=\"reference\" style=\"left:{:.2f}%\"></i>", 100.0 * chart.reference->second / longest);
}

std::string value_with_unit(double value, const std::string& unit) {
  return std::isfinite(value) && !unit.empty() ? format_value(value) + " " + unit : format_value(value);
}

std::string bar(const BarChart& chart, const BarRow& row, std::size_t series, double longest) {
  const double value = series < row.values.size() ? row.values[series] : std::nan("");
  const std::string filled = std::isfinite(value) ? fmt::format("<i style=\"width:{:.2f}%;background:{}\"></i>",
                                                                100.0 * std::clamp(value / longest, 0.0, 1.0),
                                                                series_colour(chart.series[series].role))
                                                  : "";
  return fmt::format(
      "<div class=\"bar\"><span class=\"track\">{}{}</span><span class=\"value\" title=\"{}\">{}</span></div>", filled,
      reference_mark(chart, longest), escape_html(chart.series[series].name),
      escape_html(value_with_unit(value, chart.unit)));
}

std::string bar_legend(const BarChart& chart) {
  std::string items;
  if (chart.series.size() > 1 || chart.reference) {
    for (const BarSeries& series : chart.series) {
      items += fmt::format("<span><i class=\"swatch\" style=\"background:{}\"></i>{}</span>",
                           series_colour(series.role), escape_html(series.name));
    }
  }
  if (chart.reference) {
    items += fmt::format("<span><i class=\"swatch line\"></i>{} {}</span>", escape_html(chart.reference->first),
                         escape_html(value_with_unit(chart.reference->second, chart.unit)));
  }
  return items.empty() ? "" : "<div class=\"legend\">" + items + "</div>\n";
}

}  // namespace

std::string verdict(const Verdict& verdict) {
  if (verdict.headline.empty()) return "";
  std::string sentences;
  for (const std::string& sentence : verdict.sentences) sentences += element("p", sentence);
  if (!verdict.details.empty()) {
    sentences += "<div class=\"details\">\n";
    for (const std::string& sentence : verdict.details) sentences += element("p", sentence);
    sentences += "</div>\n";
  }
  sentences += element("code", verdict.command);
  return fmt::format("<section class=\"verdict {}\" role=\"status\">\n{}{}{}</section>\n", tone_class(verdict.tone),
                     verdict.label.empty() ? "" : "<span class=\"badge\">" + escape_html(verdict.label) + "</span>\n",
                     element("h2", verdict.headline), sentences);
}

std::string bar_chart(const BarChart& chart) {
  const double longest = chart.longest();
  std::string rows;
  for (const BarRow& row : chart.rows) {
    std::string bars;
    for (std::size_t series = 0; series < chart.series.size(); ++series) bars += bar(chart, row, series, longest);
    rows += fmt::format("<tr><th scope=\"row\">{}{}</th><td>{}</td></tr>\n", escape_html(row.label),
                        row.note.empty() ? "" : "<small>" + escape_html(row.note) + "</small>", bars);
  }
  const std::string picture = fmt::format("{}<table>{}</table>\n", bar_legend(chart), rows);
  if (chart.folded)
    return fmt::format("<figure class=\"bars\">\n<details><summary>{}</summary>\n{}{}</details>\n</figure>\n",
                       escape_html(chart.title), caption_of("", chart.caption), picture);
  return fmt::format("<figure class=\"bars\">\n{}{}</figure>\n", caption_of(chart.title, chart.caption), picture);
}

std::string table(const Table& table) {
  std::vector<const char*> alignment;
  for (std::size_t column = 0; column < table.headings.size(); ++column) {
    alignment.push_back(is_numeric_column(table, column) ? " class=\"number\"" : "");
  }
  std::string head;
  for (std::size_t column = 0; column < table.headings.size(); ++column) {
    head += fmt::format("<th scope=\"col\"{}>{}</th>", alignment[column], escape_html(table.headings[column]));
  }
  std::string body;
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    const std::vector<std::string>& row = table.rows[k];
    body += "<tr>";
    for (std::size_t column = 0; column < row.size(); ++column) {
      std::string cell = escape_html(row[column]);
      if (column == 0 && k < table.links.size())
        cell = fmt::format("<a href=\"{}\">{}</a>", escape_html(table.links[k]), cell);
      body += fmt::format("<td{}{}>{}</td>", column < alignment.size() ? alignment[column] : "",
                          table.stacks && column < table.headings.size()
                              ? fmt::format(" data-heading=\"{}\"", escape_html(table.headings[column]))
                              : "",
                          cell);
    }
    body += "</tr>\n";
  }
  return fmt::format(
      "<figure class=\"table{}\">\n{}<div class=\"scroll\"><table><thead><tr>{}</tr></thead>\n<tbody>{}</tbody></table>"
      "</div>\n</figure>\n",
      table.stacks ? " stacks" : "", caption_of(table.title, table.caption), head, body);
}

std::string facts(const Facts& facts) {
  std::string items;
  for (const auto& [name, value] : facts.items) {
    items += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", escape_html(name), escape_html(value));
  }
  return fmt::format("<figure class=\"facts\">\n{}<dl>{}</dl>\n</figure>\n", caption_of(facts.title, ""), items);
}

std::string plot_frame(std::size_t index, FrameWidth width, std::string_view title, std::string_view caption,
                       std::string_view hint) {
  return fmt::format("<figure class=\"plot{}\">\n{}<div id=\"plot-{}\"></div>\n{}</figure>\n",
                     width == FrameWidth::half ? " half" : "", caption_of(title, caption), index,
                     element("small", hint));
}

}  // namespace host::html
