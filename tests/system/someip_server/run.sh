#!/usr/bin/env bash
# run.sh SOURCE_DIR BUILD_DIR RECORDINGS: the SOME/IP server of the replay and clients in two network namespaces, with a
# capture of their traffic, decoded by tshark and scapy. Exit code 77: not possible here.
set -uo pipefail
source_dir=$1
build=$2
recordings=$3
python=/usr/bin/python3
story=$source_dir/tests/system/someip_server
if [ "${4:-}" != inside ]; then
  for tool in ip nsenter tcpdump; do
    command -v "$tool" >/dev/null || { echo "skipped: $tool is not installed"; exit 77; }
  done
  how=(unshare --net --pid --fork --kill-child --mount-proc)
  "${how[@]}" true 2>/dev/null || how=("${how[@]}" --map-root-user)
  "${how[@]}" true 2>/dev/null || { echo "skipped: no namespaces here"; exit 77; }
  exec "${how[@]}" "$0" "$source_dir" "$build" "$recordings" inside
fi
out=$build/someip_server_test
rm -rf "$out"
mkdir -p "$out"

# The server's namespace is this one; that of the clients belongs to an idle process.
unshare --net sleep infinity &
clients=$!
here=$(readlink /proc/self/ns/net)
until [ "$(readlink /proc/$clients/ns/net)" != "$here" ]; do sleep 0.02; done
there() { nsenter --net=/proc/$clients/ns/net "$@"; }
ip link add server0 type veth peer name client0 2>/dev/null || { echo "skipped: no veth here"; exit 77; }
ip link set client0 netns "$clients"
ip link set lo up
ip link set server0 up
ip address add 10.66.83.1/24 dev server0
ip -6 address add fd66::1/64 dev server0 nodad
there ip link set lo up
there ip link set client0 up
there ip address add 10.66.83.2/24 dev client0
there ip -6 address add fd66::2/64 dev client0 nodad

# At the clients' end, which stays up when the link at the server's end goes down.
nsenter --net=/proc/$clients/ns/net tcpdump -i client0 -B 16384 -U -Z root -w "$out/wire.pcap" udp 2>"$out/tcpdump.txt" &
capture=$!
for _ in $(seq 100); do grep -q listening "$out/tcpdump.txt" && break; sleep 0.05; done

failed=0
there "$python" "$story/story.py" "$build/bin/boresight-replay" "$source_dir" "$recordings" $$ || failed=1
sleep 0.3
kill "$capture"
wait "$capture"
grep -q '^0 packets dropped by kernel' "$out/tcpdump.txt" || { echo "FAILED  capture lost packets"; failed=1; }

if command -v tshark >/dev/null; then
  ports=(-d udp.port==30490,someip)
  for port in $(seq 30601 30616); do ports+=(-d "udp.port==$port,someip"); done
  tshark -r "$out/wire.pcap" "${ports[@]}" -Y "ip.src==10.66.83.1 or ipv6.src==fd66::1" -T fields -e frame.number \
    -e frame.protocols -e _ws.malformed -e _ws.expert.severity -e _ws.expert.message > "$out/tshark.txt" 2>"$out/tshark.err"
  # Severity: comment 1, chat 2, note 4, warning 6 and error 8, times 0x100000.
  awk -F'\t' '
    { frames++ }
    $2 !~ /someip/ && $2 !~ /icmp/ { print "not SOME/IP: " $0; bad++ }
    $3 != "" { print "malformed: " $0; bad++ }
    { n = split($4, severity, ","); for (i = 1; i <= n; i++) if (severity[i] >= 6291456) { print "expert: " $0; bad++ } }
    END { print "tshark: " frames " frames, " bad + 0 " bad"; exit !(frames > 1000 && bad == 0) }' "$out/tshark.txt" |
    tail -20 || { echo "FAILED  tshark finds fault with what the server sends"; failed=1; }
  count() { tshark -r "$out/wire.pcap" "${ports[@]}" -Y "$1" 2>/dev/null | wc -l; }
  ended=$(count "someip.tp.flags.more_segments == 0")
  whole=$(count "someip.tp.reassembled.length")
  echo "tshark: put $whole of $ended segmented messages together"
  [ "$ended" -gt 100 ] && [ "$whole" -eq "$ended" ] || { echo "FAILED  segments"; failed=1; }
else
  echo "skipped: tshark is not installed"
fi
if "$python" -c 'import scapy.contrib.automotive.someip' 2>/dev/null; then
  "$python" "$story/check_capture.py" "$out/wire.pcap" || { echo "FAILED  scapy"; failed=1; }
else
  echo "skipped: scapy is not installed"
fi
exit $failed
