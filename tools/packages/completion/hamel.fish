# Completion of hamel in fish: share/fish/vendor_completions.d/hamel.fish.
function __hamel_candidates
    set -l helper (dirname (command -s hamel))/../share/hamel/candidates
    test -x $helper; or return
    set -l words (commandline -opc) (commandline -ct)
    for line in ($helper $words)
        if test "$line" = ':files'
            __fish_complete_path (commandline -ct)
        else
            printf '%s\n' $line
        end
    end
end
complete -c hamel -f -a '(__hamel_candidates)'
