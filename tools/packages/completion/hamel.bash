# Completion of hamel in bash: share/bash-completion/completions/hamel.
_hamel() {
  local helper name meaning words=() word i
  helper=$(dirname "$(type -P "${COMP_WORDS[0]}")")/../share/hamel/candidates
  [[ -x $helper ]] || return 0
  for ((i = 1; i <= COMP_CWORD; ++i)); do  # readline takes --scheme=lift apart at its =
    word=${COMP_WORDS[i]}
    if [[ $word == = ]]; then
      ((i < COMP_CWORD)) || words+=("")
    else
      words+=("${word//\\/}")  # as typed: without the backslashes of a name that was completed
    fi
  done
  COMPREPLY=()
  while IFS=$'\t' read -r name meaning; do
    if [[ $name == :files ]]; then
      compopt -o filenames 2>/dev/null
      mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -- "${words[-1]}")
    else
      [[ $name != *= ]] || compopt -o nospace 2>/dev/null
      printf -v name %q "$name"  # readline inserts it as it is, and bash would run $(...) in it
      COMPREPLY+=("$name")
    fi
  done < <("$helper" "${COMP_WORDS[0]}" "${words[@]}")
}
complete -F _hamel hamel
