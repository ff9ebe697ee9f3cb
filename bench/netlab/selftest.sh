#!/bin/bash
# Checks the network lab on this machine in under a minute: selftest.sh. Exit status 0: all is well.
cd "$(dirname "$0")" || exit 2
failures=0

check() {  # check NAME COMMAND...
  local name=$1
  shift
  if "$@"; then echo "ok    $name"; else echo "FAIL  $name"; failures=$((failures + 1)); fi
}

between() { awk -v x="$1" -v low="$2" -v high="$3" 'BEGIN { exit !(x != "" && x >= low && x <= high) }'; }

is() {
  [ "$1" = "$2" ] || { echo "      got '$1', expected '$2'"; return 1; }
}

in_lab() { timeout 30 ./netlab --mpi none "$@"; }

rtt_is_twice_the_delay() {  # the hosts' own share, TCP/IP stack and wake-ups, is up to 250 us when others compute
  local us=$1 median
  median=$(in_lab --realtime --delay "${us}us" -- ./measure.py rtt 100 | awk '{ print $2 }')
  echo "      round trip $median us at $us us one way"
  between "$median" $((2 * us)) $((2 * us + 250))
}

tcp_reaches() {  # headers take 3 to 4 %
  local mbit=$1 megabytes=$2 measured
  measured=$(in_lab --realtime --delay 200us --rate "${mbit}mbit" -- ./measure.py rate "$megabytes" | awk '{ print $2 }')
  echo "      $measured of $mbit Mbit/s"
  between "$measured" "$((mbit * 85 / 100))" "$mbit"
}

jitter_and_spikes_show() {
  local words
  read -r -a words < <(in_lab --realtime --delay 1ms --jitter 50% --spike 5%x10 -- ./measure.py rtt 200)
  echo "      round trips: ${words[*]}"
  between "${words[1]}" 1800 2400 && between "${words[3]}" 1000 1700 && between "${words[5]}" 6000 30000
}

hosts_differ() {
  local names
  names=$(in_lab --hosts 3 -- sh -c 'for h in lab1 lab2 lab3; do $NETLAB_ON $h hostname; done' | xargs)
  is "$names" "lab1 lab2 lab3"
}

status_is() {
  local expected=$1
  shift
  "$@" > /dev/null 2>&1
  is "$?" "$expected"
}

left_over() {  # processes of the lab that this script started, and named namespaces
  ps -eo stat,args | grep -v '^Z' | grep -F "$1" | grep -vF grep
  ip netns list
}

nothing_stays_after() {
  local signal=$1 mark=$((RANDOM + 100000)) front n
  # A daemon that left its session is the hardest to catch; the argument of sleep is the mark to find it by.
  ./netlab --mpi none --seed "$mark" -- sh -c "setsid sleep $mark & sleep $mark" > /dev/null 2>&1 &
  front=$!
  for n in $(seq 50); do
    [ "$(left_over "$mark" | grep -cE 'sleep|--hosts')" -ge 4 ] && break
    sleep 0.1
  done
  [ "$n" -lt 50 ] || { echo "      the lab did not start"; return 1; }
  kill -s "$signal" "$front"
  wait "$front" 2> /dev/null
  for n in $(seq 20); do
    [ -z "$(left_over "$mark")" ] && return 0
    sleep 0.1
  done
  left_over "$mark"
  return 1
}

mpi_runs() {
  local names
  names=$(./netlab --hosts 2 -- hostname 2> /dev/null | sort | xargs)
  is "$names" "lab1 lab2"
}

./netlab --mpi none -- true || { echo "the lab does not start here"; exit 2; }
check "names of hosts differ" hosts_differ
check "exit status of the program is passed on" status_is 42 in_lab -- sh -c 'exit 42'
check "death of the program by a signal is passed on" status_is 137 in_lab -- sh -c 'kill -9 $$'
check "a wrong option is refused" status_is 2 in_lab --delay soon -- true
for us in 0 100 1000; do check "round trip at $us us" rtt_is_twice_the_delay "$us"; done
check "jitter and spikes" jitter_and_spikes_show
check "TCP at 100 Mbit/s" tcp_reaches 100 12
check "TCP at 1000 Mbit/s" tcp_reaches 1000 64
check "nothing stays after kill -KILL" nothing_stays_after KILL
check "nothing stays after kill -TERM" nothing_stays_after TERM
if command -v mpirun > /dev/null; then
  check "mpirun starts a rank per host" mpi_runs
  check "exit status through mpirun" status_is 42 ./netlab -- sh -c 'exit 42'
fi
[ "$failures" -eq 0 ] || echo "$failures failed"
[ "$failures" -eq 0 ]
