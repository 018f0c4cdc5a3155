#include "host/workbench/page_files.hpp"

#include "host/embedded_file.hpp"
#include "host/report/assets.hpp"

AXIS_EMBED(axis_workbench_index, AXIS_PAGE_DIR "/index.html");
AXIS_EMBED(axis_workbench_style, AXIS_PAGE_DIR "/workbench.css");
AXIS_EMBED(axis_workbench_main, AXIS_PAGE_DIR "/main.js");
AXIS_EMBED(axis_workbench_elements, AXIS_PAGE_DIR "/elements.js");
AXIS_EMBED(axis_workbench_exchange, AXIS_PAGE_DIR "/exchange.js");
AXIS_EMBED(axis_workbench_adjust, AXIS_PAGE_DIR "/adjust.js");
AXIS_EMBED(axis_workbench_board, AXIS_PAGE_DIR "/board.js");
AXIS_EMBED(axis_workbench_board_parameters, AXIS_PAGE_DIR "/board_parameters.js");
AXIS_EMBED(axis_workbench_command, AXIS_PAGE_DIR "/command.js");
AXIS_EMBED(axis_workbench_commission, AXIS_PAGE_DIR "/commission.js");
AXIS_EMBED(axis_workbench_live, AXIS_PAGE_DIR "/live.js");
AXIS_EMBED(axis_workbench_motion, AXIS_PAGE_DIR "/motion.js");
AXIS_EMBED(axis_workbench_scope, AXIS_PAGE_DIR "/scope.js");
AXIS_EMBED(axis_workbench_catalogue, AXIS_PAGE_DIR "/catalogue.js");
AXIS_EMBED(axis_workbench_loop, AXIS_PAGE_DIR "/loop.js");
AXIS_EMBED(axis_workbench_look, AXIS_PAGE_DIR "/look.js");
AXIS_EMBED(axis_workbench_choice, AXIS_PAGE_DIR "/choice.js");
AXIS_EMBED(axis_workbench_compare, AXIS_PAGE_DIR "/compare.js");
AXIS_EMBED(axis_workbench_effects, AXIS_PAGE_DIR "/effects.js");
AXIS_EMBED(axis_workbench_figures, AXIS_PAGE_DIR "/figures.js");
AXIS_EMBED(axis_workbench_gallery, AXIS_PAGE_DIR "/gallery.js");
AXIS_EMBED(axis_workbench_jobs, AXIS_PAGE_DIR "/jobs.js");
AXIS_EMBED(axis_workbench_opening, AXIS_PAGE_DIR "/opening.js");
AXIS_EMBED(axis_workbench_plot_axes, AXIS_PAGE_DIR "/plot_axes.js");
AXIS_EMBED(axis_workbench_plot_files, AXIS_PAGE_DIR "/plot_files.js");
AXIS_EMBED(axis_workbench_plot_svg, AXIS_PAGE_DIR "/plot_svg.js");
AXIS_EMBED(axis_workbench_record, AXIS_PAGE_DIR "/record.js");
AXIS_EMBED(axis_workbench_repeat, AXIS_PAGE_DIR "/repeat.js");
AXIS_EMBED(axis_workbench_report_parts, AXIS_PAGE_DIR "/report_parts.js");
AXIS_EMBED(axis_workbench_stops, AXIS_PAGE_DIR "/stops.js");

namespace host::workbench {

const std::vector<PageFile>& page_files() {
  constexpr std::string_view kScript = "text/javascript; charset=utf-8", kStyle = "text/css; charset=utf-8";
#define AXIS_PAGE_FILE(SYMBOL) embedded_file(axis_workbench_##SYMBOL##_begin, axis_workbench_##SYMBOL##_end)
  static const std::vector<PageFile> files{
      {"index.html", "text/html; charset=utf-8", AXIS_PAGE_FILE(index)},
      {"workbench.css", kStyle, AXIS_PAGE_FILE(style)},
      {"main.js", kScript, AXIS_PAGE_FILE(main)},
      {"elements.js", kScript, AXIS_PAGE_FILE(elements)},
      {"exchange.js", kScript, AXIS_PAGE_FILE(exchange)},
      {"adjust.js", kScript, AXIS_PAGE_FILE(adjust)},
      {"board.js", kScript, AXIS_PAGE_FILE(board)},
      {"board_parameters.js", kScript, AXIS_PAGE_FILE(board_parameters)},
      {"command.js", kScript, AXIS_PAGE_FILE(command)},
      {"commission.js", kScript, AXIS_PAGE_FILE(commission)},
      {"live.js", kScript, AXIS_PAGE_FILE(live)},
      {"motion.js", kScript, AXIS_PAGE_FILE(motion)},
      {"scope.js", kScript, AXIS_PAGE_FILE(scope)},
      {"catalogue.js", kScript, AXIS_PAGE_FILE(catalogue)},
      {"loop.js", kScript, AXIS_PAGE_FILE(loop)},
      {"look.js", kScript, AXIS_PAGE_FILE(look)},
      {"choice.js", kScript, AXIS_PAGE_FILE(choice)},
      {"compare.js", kScript, AXIS_PAGE_FILE(compare)},
      {"effects.js", kScript, AXIS_PAGE_FILE(effects)},
      {"figures.js", kScript, AXIS_PAGE_FILE(figures)},
      {"gallery.js", kScript, AXIS_PAGE_FILE(gallery)},
      {"jobs.js", kScript, AXIS_PAGE_FILE(jobs)},
      {"opening.js", kScript, AXIS_PAGE_FILE(opening)},
      {"plot_axes.js", kScript, AXIS_PAGE_FILE(plot_axes)},
      {"plot_files.js", kScript, AXIS_PAGE_FILE(plot_files)},
      {"plot_svg.js", kScript, AXIS_PAGE_FILE(plot_svg)},
      {"record.js", kScript, AXIS_PAGE_FILE(record)},
      {"repeat.js", kScript, AXIS_PAGE_FILE(repeat)},
      {"report_parts.js", kScript, AXIS_PAGE_FILE(report_parts)},
      {"stops.js", kScript, AXIS_PAGE_FILE(stops)},
      {"dygraphs.js", kScript, assets::dygraphs_script()},
      {"synchronizer.js", kScript, assets::synchronizer_script()},
      {"dygraphs.css", kStyle, assets::dygraphs_style()},
      {"heat_map.js", kScript, assets::heat_map_script()},
      {"report.js", kScript, assets::report_script()},
      {"report.css", kStyle, assets::report_style()},
  };
#undef AXIS_PAGE_FILE
  return files;
}

}  // namespace host::workbench
