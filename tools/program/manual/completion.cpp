#include <waymark/tools/program/manual/completion.hpp>

#include <algorithm>
#include <array>
#include <memory>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/program/command_line.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/program/manual/option_text.hpp>
#include <waymark/tools/simulation/simulation.hpp>
#include <waymark/version.hpp>

namespace waymark::program {
namespace {

using Names = std::vector<std::string>;

// ---- Names that the program knows

template <typename Table, typename NameOf>
Names names_in(const Table& table, NameOf name_of) {
  Names names;
  for (const auto& entry : table) names.push_back(name_of(entry.type));
  return names;
}

constexpr auto kName = [](const auto& type) { return std::string(type.name); };

Names losses(const TypeRegistry& registry) {
  return names_in(registry.losses(), [](const LossType& loss) { return loss.name + ":"; });
}

Names presets(const TypeRegistry&) {
  Names names;
  for (const simulation::SimulationPreset& preset : simulation::simulation_presets())
    names.push_back(preset.name);
  return names;
}

/// A kind of name in type names, and the source of the names.
struct NameKind {
  const char* kind;
  Names (*names)(const TypeRegistry& registry);
};
const std::array kNameKinds = {
    NameKind{"ALGORITHM", [](const TypeRegistry& r) { return names_in(r.algorithms(), kName); }},
    NameKind{"SOLVER", [](const TypeRegistry& r) { return names_in(r.linear_solvers(), kName); }},
    NameKind{"START", [](const TypeRegistry& r) { return names_in(r.starts(), kName); }},
    NameKind{"MODELING", [](const TypeRegistry& r) { return names_in(r.gnss_modelings(), kName); }},
    NameKind{"LOSS:SCALE", losses},
    NameKind{"[TAG=]LOSS:SCALE", losses},
    NameKind{"TAG",
             [](const TypeRegistry& r) {
               return names_in(r.edges(), [](const EdgeType& edge) { return std::string(edge.tag); });
             }},
    NameKind{"LOG_FORMAT", [](const TypeRegistry& r) { return names_in(r.log_readers(), kName); }},
    NameKind{"PRESET", presets},
    NameKind{"PLUGIN", [](const TypeRegistry&) { return installed_plugin_names(); }}};

const NameKind* find_kind(const std::string& kind) {
  const auto found = std::find_if(kNameKinds.begin(), kNameKinds.end(),
                                  [&](const NameKind& known) { return known.kind == kind; });
  return found == kNameKinds.end() ? nullptr : &*found;
}

// ---- The script

/// Returns the offer of one alternative of a type name, in the form that the function of the script
/// reads; empty: nothing.
std::string offer_of(const std::string& alternative) {
  if (is_name_kind(alternative)) return "names:" + alternative;
  if (alternative == "DIR") return "folders";
  if (alternative == "FILE" || alternative == "LOG") return "files";
  if (alternative == "GRAPH") return "files:graph files:g2o";
  if (alternative == "DRIVE.yaml") return "files:yaml files:yml";
  const auto dot = alternative.rfind('.');
  if (dot != std::string::npos) return "files:" + alternative.substr(dot + 1);
  const bool literal =
      std::none_of(alternative.begin(), alternative.end(), [](char c) { return c >= 'A' && c <= 'Z'; });
  return literal ? "word:" + alternative : "";
}

std::string offers_of(std::string value, const Names& subcommands) {
  constexpr std::string_view kList = "[,...]";
  std::string offers;
  if (value.ends_with(kList)) {
    value.resize(value.size() - kList.size());
    offers = "list";
  }
  if (value == "SUBCOMMAND") value = CLI::detail::join(subcommands, "|");
  for (const std::string& alternative : split_text(value, "|")) {
    const std::string offer = offer_of(alternative);
    if (!offer.empty()) offers += (offers.empty() ? "" : " ") + offer;
  }
  return offers;
}

/// Returns the cases of one command: its words, the values of each option, and its positional.
std::string cases_of(const std::string& name, const CLI::App& command, const Names& subcommands) {
  std::string words;
  std::string cases;
  std::string positional;
  for (const OptionText& option : option_texts(command)) {
    if (option.positional()) {
      positional = offers_of(option.value, subcommands);
      continue;
    }
    words += (words.empty() ? "" : " ") + CLI::detail::join(option.names, " ");
    if (option.value.empty()) continue;
    std::string patterns;
    for (const std::string& flag : option.names) {
      patterns += fmt::format("{}'{} {}'", patterns.empty() ? "" : "|", name, flag);
    }
    cases += fmt::format("    {}) offers='{}'; needs_value=1 ;;\n", patterns,
                         offers_of(option.value, subcommands));
  }
  return fmt::format("    '{} ') options='{}'; offers='{}' ;;\n", name, words, positional) + cases;
}

constexpr const char* kScriptHead =
    R"bash(# Completion of waymark {} for bash, written by 'waymark completion bash'.

# Adds to COMPREPLY what begins like the word: _waymark_offer WORD OFFER...
#   list      the word is a list with commas, its last part is completed
#   word:W    a word; names:KIND  names that the program and its plugins know
#   folders, files, files:SUFFIX
_waymark_offer()
{{
  local word=$1 before='' offer
  local IFS=$'\n'
  shift
  for offer; do
    case $offer in
      list) [[ $word != *,* ]] || {{ before=${{word%,*}},; word=${{word##*,}}; }} ;;
      word:*) COMPREPLY+=($(compgen -P "$before" -W "${{offer#word:}}" -- "$word")) ;;
      names:*) COMPREPLY+=($(compgen -P "$before" -W \
        "$("${{COMP_WORDS[0]}}" completion --values "${{offer#names:}}" "${{plugins[@]}}" 2>/dev/null)" -- "$word")) ;;
      folders) compopt -o filenames 2>/dev/null; COMPREPLY+=($(compgen -d -- "$word")) ;;
      files) compopt -o filenames 2>/dev/null; COMPREPLY+=($(compgen -f -- "$word")) ;;
      files:*) compopt -o filenames 2>/dev/null
        COMPREPLY+=($(compgen -f -X "!*.${{offer#files:}}" -- "$word") $(compgen -d -- "$word")) ;;
    esac
  done
  # Folders come once, however many suffixes were asked for.
  [[ ${{#COMPREPLY[@]}} -eq 0 ]] || COMPREPLY=($(printf '%s\n' "${{COMPREPLY[@]}}" | sort -u))
  # "huber:" waits for its scale.
  [[ ${{COMPREPLY[*]}} != *: ]] || compopt -o nospace 2>/dev/null
  return 0
}}

_waymark()
{{
  local word=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}}
  local command='' options='' offers='' needs_value='' i
  local plugins=()
  COMPREPLY=()
  # The shell takes '--solver=x' and 'huber:1' apart.
  if [[ $word == = ]]; then
    word=''
  elif [[ $previous == = ]]; then
    previous=${{COMP_WORDS[COMP_CWORD - 2]}}
  fi
  [[ $word != : && $previous != : ]] || return 0
  for ((i = 1; i < COMP_CWORD; ++i)); do
    [[ -n $command || ${{COMP_WORDS[i]}} == -* ]] || command=${{COMP_WORDS[i]}}
    [[ ${{COMP_WORDS[i]}} != --plugin || $((i + 1)) -eq COMP_CWORD ]] || plugins+=(--plugin "${{COMP_WORDS[i + 1]}}")
  done
)bash";

constexpr const char* kScriptTail = R"bash(    esac
  done
  if [[ -z $needs_value && $word == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$word"))
  else
    local -a list
    read -ra list <<< "$offers"
    _waymark_offer "$word" "${list[@]}"
  fi
}
complete -F _waymark waymark
)bash";

/// Completes the last of some words in bash, for other shells: program, words.
constexpr const char* kAskBash =
    R"(bash -c 'source <("$1" completion bash); shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _waymark; )"
    R"(printf "%s\n" "${COMPREPLY[@]}"' bash)";

constexpr const char* kZsh = R"zsh(#compdef waymark
# Completion of waymark {0} for zsh, written by 'waymark completion zsh'.
_waymark()
{{
  local -a found
  found=(${{(f)"$({1} "${{words[1]}}" "${{(@)words[1,CURRENT]}}" 2>/dev/null)"}})
  (( ${{#found}} )) || return 1
  # "huber:" waits for its scale.
  if [[ ${{found[1]}} == *: ]]; then compadd -S '' -a found; else compadd -f -a found; fi
}}
if [[ ${{zsh_eval_context[-1]}} == loadautofunc ]]; then _waymark "$@"; else compdef _waymark waymark; fi
)zsh";

constexpr const char* kFish =
    R"fish(# Completion of waymark {0} for fish, written by 'waymark completion fish'.
function __waymark_complete
    set -l all (commandline -opc) (commandline -ct)
    {1} $all[1] $all 2>/dev/null
end
complete -c waymark -f -a '(__waymark_complete)'
)fish";

struct CompletionOptions {
  CommonOptions common;
  std::string shell;
  std::string kind;
};

ExitCode complete(const CLI::App& app, CompletionOptions& options) {
  std::string text;
  if (options.kind.empty()) {
    if (options.shell.empty()) throw UsageError("shell is required: waymark completion bash");
    text = options.shell == "bash" ? bash_completion(app) : other_completion(options.shell);
  } else {
    options.common.quiet = true;  // nobody sees warnings while a word is completed
    const TypeRegistry registry = make_registry(options.common);
    for (const std::string& name : completion_values(options.kind, registry)) text += name + "\n";
  }
  formats::write_file_atomically("-", text);
  return kSuccess;
}

}  // namespace

bool is_name_kind(const std::string& kind) {
  return find_kind(kind) != nullptr;
}

std::vector<std::string> completion_values(const std::string& kind, const TypeRegistry& registry) {
  if (const NameKind* found = find_kind(kind)) return found->names(registry);
  Names known;
  for (const NameKind& name_kind : kNameKinds) known.emplace_back(name_kind.kind);
  throw UsageError("unknown kind of names '" + kind +
                   "'; there are: " + joined(std::span<const std::string>(known)));
}

std::string bash_completion(const CLI::App& app) {
  const std::vector<const CLI::App*> commands = app.get_subcommands([](const CLI::App*) { return true; });
  Names names;
  for (const CLI::App* command : commands) names.push_back(command->get_name());
  std::string script = fmt::format(kScriptHead, WAYMARK_VERSION);
  script += "  # What the command has, then what stands behind its option.\n";
  script += "  for i in '' \"$previous\"; do\n    case \"$command $i\" in\n";
  std::string top = cases_of("", app, names);
  const std::string no_offers = "offers=''";
  top.replace(top.find(no_offers), no_offers.size(), "offers='" + offers_of("SUBCOMMAND", names) + "'");
  script += top;
  for (const CLI::App* command : commands) script += cases_of(command->get_name(), *command, names);
  return script + kScriptTail;
}

std::string other_completion(const std::string& shell) {
  return fmt::format(fmt::runtime(shell == "zsh" ? kZsh : kFish), WAYMARK_VERSION, kAskBash);
}

void add_completion(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "completion",
      "Print a script that completes the program's words in the shell\n\n"
      "Subcommands, options, their values and files are completed. The script asks the program for "
      "the names of solvers and modelings, so those of plugins are completed too. An installed "
      "program has the script in the folder that bash-completion searches. The scripts for zsh and fish "
      "ask bash.");
  const auto options = std::make_shared<CompletionOptions>();
  auto* shell = command->add_option("shell", options->shell, "Shell to write for")
                    ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->add_option("--values", options->kind)->group("")->excludes(shell);
  add_plugin_option(*command, options->common);
  command->footer(
      "Example:\n  source <(waymark completion bash)\n  source <(waymark completion zsh)\n  waymark completion fish | source");
  command->callback(
      [options, &app, &action] { action = [options, &app] { return complete(app, *options); }; });
}

}  // namespace waymark::program
