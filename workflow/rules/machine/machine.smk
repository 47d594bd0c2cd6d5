# The floor machine: where to run one's own conveyor, the drive from an accelerometer, and parameters from measured velocities.


include: "common.smk"


# A figure of a measured file has the name of the section that names this file.
NO_FIGURES |= {section: reason for section, reason in NOT_MEASURED.items() if not MEASURED[section]}


include: "operating.smk"
include: "contact.smk"
include: "excitation.smk"
include: "calibration.smk"


MACHINE_FILES = [*OPERATING_FILES, *CONTACT_FILES, *EXCITATION_FILES, *CALIBRATION_FILES]
FLOOR_FILES += MACHINE_FILES


rule machine:
    """The answers for this machine."""
    input:
        MACHINE_FILES,
    localrule: True
