# A fixed amount of work for one processor. Its time in the guest over its time on the host is the factor of emulation.
for ((i = 0; i < 300000; i++)); do :; done
