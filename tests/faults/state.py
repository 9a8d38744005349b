"""The product's persisted states, read as a workshop would."""
import subprocess

ALIGNMENT, FAULT_MEMORY = "alignment", "fault_memory"
MISALIGNED_CODE = "C1D02-78"  # of the radar that the shipped drive misaligns


def stored_codes(product):
    """Output of `boresight dtc list` from the file."""
    done = subprocess.run([product.bin / "boresight", "dtc", "list", "--state", product.state / FAULT_MEMORY, "--vehicle",
                           product.vehicle], capture_output=True, text=True, check=False, env=product.environment)
    return done.stdout + done.stderr


def losses(product):
    """What is lost or set aside as unreadable; a file that was set aside is counted once."""
    lost = [f"no file {name}" for name in (ALIGNMENT, FAULT_MEMORY) if not (product.state / name).is_file()]
    for rejected in product.state.glob("*.rejected"):
        lost.append(f"{rejected.name}: a state that the product itself wrote is unreadable")
        rejected.unlink()
    if FAULT_MEMORY not in " ".join(lost) and MISALIGNED_CODE not in (codes := stored_codes(product)):
        lost.append(f"{FAULT_MEMORY} lost {MISALIGNED_CODE}: {codes.strip()[:200]}")
    return lost
