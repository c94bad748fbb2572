#include "lines/page_lines.hpp"

#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "commands.hpp"
#include "lines/number_option.hpp"
#include "lines/run_line.hpp"

namespace hamel::tools {

Action define_report(CLI::App& app) {
  const auto options = std::make_shared<ReportOptions>();
  app.add_option("FILE", options->files, "recorded runs, .h5 (hamel run -o x.h5)")->required();
  app.add_option("-o,--output", options->output,
                 "the page [report.html]; of a figure .pdf, .svg or .png; of a motion below");
  CLI::Option* figure =
      app.add_option("--figure", options->figure,
                     "write this figure alone, drawn by chromium: error, energy, motion, ... (an "
                     "unknown name lists those there are)");
  app.add_option("--width", options->width, "of the figure: 8cm, 80mm, 3in, 230pt [12cm]")
      ->needs(figure);
  CLI::Option* motion =
      app.add_flag(
             "--motion", options->motion,
             "write the motion alone: a film (.webm, .gif), a picture (.png, .svg, .pdf) or a "
             "page to play it (.html), drawn by chromium, films by ffmpeg too; a page needs "
             "neither")
          ->excludes(figure);
  number_option<double>(
      app, "--at", [options](double at) { options->at = at; },
      "of a picture: the time it shows, in s [the end]")
      ->needs(motion);
  number_option<long>(
      app, "--strobe", [options](long count) { options->strobe = count; },
      "of a picture: the bodies at so many times up to --at")
      ->needs(motion);
  number_option<double>(
      app, "--speed", [options](double speed) { options->speed = speed; },
      "of a film: so many times faster than the motion [so that it takes 4 to 25 s]")
      ->needs(motion);
  app.add_option("--size", options->size,
                 "of a motion, in pixels: 1280x720 [.gif 640x360, .html its window]")
      ->needs(motion);
  app.add_flag("--transparent", options->transparent, "of a motion: no ground colour")
      ->needs(motion);
  app.footer(
      "Examples:\n"
      "  hamel report disk.h5 -o disk.html\n"
      "  hamel report lift.h5 balance.h5 rkmk4.h5 -o compared.html\n"
      "  hamel report disk.h5 --figure energy-error -o energy.pdf --width 8cm\n"
      "  hamel report disk.h5 --motion -o disk.webm\n"
      "  hamel report disk.h5 --motion -o disk.svg --strobe 8 --at 3");
  return [options] { return report(*options); };
}

Action define_live(CLI::App& app) {
  const auto options = std::make_shared<LiveOptions>();
  const auto line = std::make_shared<RunLine>();
  app.add_option("SYSTEM", options->system,
                 "a system (hamel list systems) or a file, my_system.toml, run.toml")
      ->required();
  CLI::Option* output =
      app.add_option("-o,--output", options->output,
                     "the page, one file [SYSTEM-live.html in the folder of temporary files]");
  number_option<long>(
      app, "--port", [options](long port) { options->port = port; },
      "serve the page at http://localhost:PORT until Ctrl-C; 0: any that is free");
  app.add_flag_callback(
      "--no-open", [options] { options->open = false; }, "open no browser");
  line->define_options(app, {});
  group_run_options(app);
  output->group("Options");
  app.footer(
      "The playground with this system in it: an editor and sliders beside the motion. It needs no "
      "server; the page is tools/playground's, which this program finds where it was built or "
      "installed, or at HAMEL_PLAYGROUND. Options of a run are its sliders, and go with its "
      "links.\n"
      "Examples:\n"
      "  hamel live bicycle\n"
      "  hamel live bicycle --speed 5 --until 3 --input steer.torque=0.2\n"
      "  hamel live robot.toml -o robot.html\n"
      "  hamel live robot.toml --port 8000     # from another machine: ssh -L 8000:localhost:8000");
  return [options, line, &app] {
    line->system = options->system;
    options->config = line->resolve(app).config;
    options->given = RunLine::given(app);
    return live(*options);
  };
}

}  // namespace hamel::tools
