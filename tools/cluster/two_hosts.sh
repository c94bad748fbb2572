#!/bin/bash
# Two hosts on one machine, to try MPI over ssh: two network namespaces of their own, each with its
# host name and sshd, joined by a veth pair (10.77.0.1, 10.77.0.2: addresses inside them alone).
#
#   sudo tools/cluster/two_hosts.sh COMMAND [WORD...]
#
# runs the command on the first one. $HOSTS is "10.77.0.1,10.77.0.2", $OTHER the second namespace, and
# mpirun starts its ranks by the right ssh, so that in the command
#
#   mpirun --host $HOSTS -n 2 hamel ensemble many.toml -o many
#
# has a rank on each. Needs root, iproute2, sshd, Open MPI; nothing is left behind.
set -euo pipefail
[ $# -gt 0 ] || { sed -n '2,12s/^# \{0,1\}//p' "$0"; exit 2; }
for program in ip ssh sshd mpirun; do
  command -v "$program" > /dev/null || { echo "two_hosts.sh: no $program" >&2; exit 77; }
done
first=hamel-a-$$ other=hamel-b-$$ work=$(mktemp -d)
end() {
  for name in "$first" "$other"; do
    [ ! -s "$work/$name.pid" ] || kill "$(cat "$work/$name.pid")" 2> /dev/null || true
    ip netns del "$name" 2> /dev/null || true
  done
  rm -rf "$work"
}
trap end EXIT
ip netns add "$first" 2> /dev/null || { echo "two_hosts.sh: no right to make a network namespace" >&2; exit 77; }
ip netns add "$other"
ip link add veth0 netns "$first" type veth peer name veth0 netns "$other"
ssh-keygen -q -t ed25519 -N '' -f "$work/key"
ssh-keygen -q -t ed25519 -N '' -f "$work/host"
cp "$work/key.pub" "$work/allowed"
mkdir -p /run/sshd  # where sshd drops its rights
address=1
for name in "$first" "$other"; do
  ip -n "$name" link set lo up
  ip -n "$name" addr add "10.77.0.$address/24" dev veth0
  ip -n "$name" link set veth0 up
  cat > "$work/$name.conf" << CONFIG
ListenAddress 10.77.0.$address:22
HostKey $work/host
AuthorizedKeysFile $work/allowed
PidFile $work/$name.pid
StrictModes no
UsePAM no
PasswordAuthentication no
PermitRootLogin prohibit-password
CONFIG
  ip netns exec "$name" unshare --uts bash -c "hostname ${name%-*} && $(command -v sshd) -f $work/$name.conf"
  address=$((address + 1))
done
cat > "$work/ssh.conf" << CONFIG
IdentityFile $work/key
StrictHostKeyChecking no
UserKnownHostsFile /dev/null
LogLevel ERROR
CONFIG
export HOSTS=10.77.0.1,10.77.0.2 OTHER=$other
export OMPI_MCA_plm_rsh_agent="ssh -F $work/ssh.conf" OMPI_MCA_oob_tcp_if_include=veth0
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
# Not exec: the trap takes the hosts down.
ip netns exec "$first" unshare --uts bash -c 'hostname hamel-a && exec "$@"' -- "$@"
