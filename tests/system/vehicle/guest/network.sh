# The buses of vehicle.toml: vcan0, vcan1, and ecu0 with the radars' end of the cable in the namespace `radars`.
set -e
for bus in vcan0 vcan1; do
  ip link add "$bus" type vcan
  ip link set "$bus" mtu 72 # a CAN FD frame
  ip link set "$bus" up
done
ip link set lo up multicast on
ip netns add radars
ip link add ecu0 type veth peer name radar0 netns radars
ip address add 10.13.1.2/24 dev ecu0
ip link set ecu0 up
ip -n radars address add 10.13.1.113/24 dev radar0
ip -n radars link set lo up
ip -n radars link set radar0 up
