# SPDX-License-Identifier: GPL-3.0-or-later
"""German: labels of panels, names and tooltips of settings and operators. Units and people's names stay as they are.

`tools/list_untranslated.py` lists what is missing here and what is no longer said.
"""

LABELS = {
    # Panels and what they draw
    "Absorption": "Absorption",
    "Animation and Farm": "Animation und Farm",
    "Beam Shape": "Strahlform",
    "Clouded": "Getrübt",
    "Rendered by its numbers, which are not the species' own": "Nach seinen Zahlen gerendert, die nicht die der Art sind",
    "Comparison with Cycles": "Vergleich mit Cycles",
    "Cycles and EEVEE Twin": "Zwilling für Cycles und EEVEE",
    "Denoise": "Entrauschen",
    "Dispersion": "Dispersion",
    "Environment": "Umgebung",
    "Film": "Film",
    "Filter": "Filter",
    "Gem": "Edelstein",
    "Include": "Einschließen",
    "Light Paths": "Lichtpfade",
    "Media": "Medien",
    "Medium": "Medium",
    "Motion Blur": "Bewegungsunschärfe",
    "Nodes": "Nodes",
    "Opal": "Opal",
    "Opal over Cycles": "Opal über Cycles",
    "Passes": "Durchgänge",
    "Performance": "Leistung",
    "Photons": "Photonen",
    "Polarizing Filter": "Polarisationsfilter",
    "Rainbow": "Regenbogen",
    "Ray Visibility": "Strahlensichtbarkeit",
    "Report": "Bericht",
    "Simplify": "Vereinfachen",
    "Surfaces": "Oberflächen",
    "Max Subdivision Viewport": "Unterteilung höchstens, Ansicht",
    "Max Child Particles Viewport": "Kindpartikel höchstens, Ansicht",
    "Render": "Rendern",
    "Volume Resolution": "Volumenauflösung",
    "Render Presets": "Rendervorgaben",
    "Material Presets": "Materialvorgaben",
    "Sampling": "Abtastung",
    "Spectral EXR": "Spektrales EXR",
    "Spectrum": "Spektrum",
    "Surface": "Oberfläche",
    "C (µm²)": "C (µm²)",
    "Color": "Farbe",
    "Data": "Daten",
    "Depth": "Tiefe",
    "Dispersion (µm²)": "Dispersion (µm²)",
    "Emission": "Emission",
    "Emission (1/m)": "Emission (1/m)",
    "Estimate": "Schätzung",
    "Extinction (1/m)": "Extinktion (1/m)",
    "First (nm)": "Erste (nm)",
    "Formula": "Formel",
    "From": "Aus",
    "Indirect": "Indirekt",
    "Keep": "Behalten",
    "Last": "Letzte",
    "Light": "Licht",
    "Lorenz-Mie is right for drops below 0.05 mm": "Für Tropfen unter 0,05 mm stimmt Lorenz-Mie",
    "Normal": "Normale",
    "Phase": "Phase",
    "Photons per Pass": "Photonen je Durchgang",
    "Position": "Position",
    "Radius": "Radius",
    "Radius (mm)": "Radius (mm)",
    "Salinity (‰)": "Salzgehalt (‰)",
    "Scene": "Szene",
    "Steps": "Schritte",
    "Temperature (°C)": "Temperatur (°C)",
    "The spectrum takes the place of the lamp's temperature": "Das Spektrum tritt an die Stelle der Farbtemperatur der Lampe",
    "Tolerance": "Toleranz",
    "Transparent": "Transparent",
    "Wavelength (nm)": "Wellenlänge (nm)",
    "Source": "Quelle",
    # Settings
    "Absorption Color": "Absorptionsfarbe",
    "Absorption Curve": "Absorptionskurve",
    "Absorption Depth": "Absorptionstiefe",
    "Adaptive Sampling": "Adaptive Abtastung",
    "Albedo": "Albedo",
    "Angle": "Winkel",
    "Anisotropy": "Anisotropie",
    "B": "B",
    "Base Height": "Basishöhe",
    "Bins": "Bänder",
    "C": "C",
    "Caustics": "Kaustiken",
    "Clamp Direct": "Direkt begrenzen",
    "Clamp Indirect": "Indirekt begrenzen",
    "Contrast": "Kontrast",
    "Density": "Dichte",
    "Detail": "Detail",
    "Direct": "Direkt",
    "Emission Color": "Emissionsfarbe",
    "Emission Grid": "Emissionsgitter",
    "Emission Strength": "Emissionsstärke",
    "Exposure": "Belichtung",
    "Extinction": "Extinktion",
    "Extinction Color": "Extinktionsfarbe",
    "File": "Datei",
    "Film File": "Filmdatei",
    "First Pass": "Erster Durchgang",
    "Flattening": "Abplattung",
    "Forward Lobe": "Vorwärtskeule",
    "Fresnel": "Fresnel",
    "Gather": "Sammeln",
    "Grid": "Gitter",
    "Index": "Brechzahl",
    "Kind": "Art",
    "Liquid": "Flüssigkeit",
    "March Steps": "Schritte",
    "March Tolerance": "Schritttoleranz",
    "Max Depth": "Größte Tiefe",
    "Noise Threshold": "Rauschschwelle",
    "Phase Function": "Phasenfunktion",
    "Photons Carry": "Photonen tragen",
    "Pixel Filter": "Pixelfilter",
    "Polarization": "Polarisation",
    "Preset": "Vorgabe",
    "Priority": "Vorrang",
    "Radius Shrink": "Radius verkleinern",
    "Roughness": "Rauheit",
    "Salinity": "Salzgehalt",
    "Samples per Pass": "Abtastungen je Durchgang",
    "Scale Height": "Skalenhöhe",
    "Seed": "Startwert",
    "Size": "Größe",
    "Sizes": "Größen",
    "Species": "Steinart",
    "Spread": "Streuung",
    "Temperature": "Temperatur",
    "Theory": "Theorie",
    "Time Limit": "Zeitgrenze",
    "Transparent Depth": "Transparente Tiefe",
    "Vary Seed": "Startwert wechseln",
    "Volume Estimate": "Schätzung in Medien",
    "Volume Photons": "Photonen für Medien",
    "Volume Radius": "Radius in Medien",
    "Wavelength": "Wellenlänge",
    "Wavelengths": "Wellenlängen",
    "Width": "Breite",
    # Choices
    "All": "Alles",
    "Beam Radiance": "Strahldichte",
    "Beams": "Strahlen",
    "Black Body": "Schwarzer Körper",
    "Blackbody": "Schwarzer Körper",
    "Box": "Kasten",
    "Curve": "Kurve",
    "Daylight (D65)": "Tageslicht (D65)",
    "Descartes, Sampled": "Descartes, abgetastet",
    "Droplet": "Tropfen",
    "Exact": "Exakt",
    "Fluorescent (F2)": "Leuchtstoff (F2)",
    "Fluorescent, Three Bands (F11)": "Leuchtstoff, drei Banden (F11)",
    "Homogeneous": "Gleichmäßig",
    "Incandescent (A)": "Glühlampe (A)",
    "Isotropic": "Isotrop",
    "Laser": "Laser",
    "Log-Normal": "Log-Normal",
    "Noise": "Rauschen",
    "None": "Nichts",
    "One Size": "Eine Größe",
    "Other": "Andere",
    "Points": "Punkte",
    "Sea Water": "Meerwasser",
    "Sodium": "Natrium",
    "Two Sizes": "Zwei Größen",
    "Water": "Wasser",
    "White LED": "Weiße LED",
}

TOOLTIPS = {
    # Render
    "How many times the whole picture is rendered anew, with new photons; the passes are averaged, so more passes give less noise and "
    "smaller blur in caustics": "Wie oft das ganze Bild mit neuen Photonen berechnet wird; die Durchgänge werden gemittelt, mehr davon "
    "geben weniger Rauschen und schärfere Kaustiken",
    "How many camera paths each pixel gets in one pass": "Wie viele Kamerapfade jedes Pixel in einem Durchgang bekommt",
    "Look before the first pass where the noise will be: more camera paths go there, and photons and paths are weighed against each "
    "other. Samples and photons per pass then say how much work a pass is, not how it is shared out": "Vor dem ersten Durchgang wird "
    "gesucht, wo es rauschen wird: Dorthin gehen mehr Kamerapfade, und Photonen und Pfade werden gegeneinander abgewogen. Abtastungen "
    "und Photonen je Durchgang sagen dann, wie viel Arbeit ein Durchgang ist, nicht wie sie verteilt wird",
    "How many photons each pass sends out from lamps, emissive meshes and the world; 0 leaves all light to camera paths": "Wie viele "
    "Photonen jeder Durchgang von Lampen, leuchtenden Netzen und der Welt aussendet; 0 überlässt alles Licht den Kamerapfaden",
    "Which light the photons bring; camera paths bring the rest. All choices converge to the same picture": "Welches Licht die Photonen "
    "bringen; den Rest bringen Kamerapfade. Alle Möglichkeiten führen zum selben Bild",
    "How many photons one estimate of light uses at most": "Wie viele Photonen eine Schätzung des Lichts höchstens verwendet",
    "Radius within which photons count in the first pass; 0 chooses four pixels' width at the distance of the gems": "Radius, in dem "
    "Photonen im ersten Durchgang zählen; 0 wählt die Breite von vier Pixeln in der Entfernung der Edelsteine",
    "How slowly the radius shrinks from pass to pass: 1 keeps it and its blur, smaller values trade blur for noise. Two thirds is best "
    "for surfaces (Knaus and Zwicker 2011)": "Wie langsam der Radius von Durchgang zu Durchgang schrumpft: 1 behält ihn und seine "
    "Unschärfe, kleinere Werte tauschen Unschärfe gegen Rauschen. Zwei Drittel sind für Oberflächen am besten (Knaus und Zwicker 2011)",
    "How light that photons bring to media is found. All three converge to the same picture": "Wie das Licht gefunden wird, das Photonen "
    "in Medien bringen. Alle drei führen zum selben Bild",
    "How many photons each pass sends out for media alone; 0 lets the same photons serve surfaces and media": "Wie viele Photonen jeder "
    "Durchgang allein für Medien aussendet; bei 0 dienen dieselben Photonen Oberflächen und Medien",
    "Radius within which photons in media count in the first pass; 0 takes Radius, and if that is 0 too, chooses by the photons": "Radius, "
    "in dem Photonen in Medien im ersten Durchgang zählen; 0 nimmt Radius, und wenn auch der 0 ist, wählen ihn die Photonen",
    "Places along each ray where Points looks for photons": "Stellen entlang jedes Sehstrahls, an denen Punkte nach Photonen sucht",
    "A step of Points is halved where its light differs from its neighbour's by more than this share; 0 halves none": "Ein Schritt von "
    "Punkte wird halbiert, wo sein Licht um mehr als diesen Anteil von dem des Nachbarn abweicht; 0 halbiert keinen",
    "After how many bounces a path ends at the latest; dim paths end before, by chance and without darkening": "Nach wie vielen Stößen ein "
    "Pfad spätestens endet; schwache Pfade enden früher, durch Zufall und ohne das Bild zu verdunkeln",
    "How many transparent surfaces one ray passes at most": "Wie viele durchsichtige Flächen ein Strahl höchstens durchquert",
    "First and last wavelength of the light rendered, in nanometres; the eye sees little outside 380 to 730": "Erste und letzte Wellenlänge "
    "des berechneten Lichts in Nanometern; außerhalb von 380 bis 730 sieht das Auge wenig",
    "Removes the remaining noise after the last pass by Intel Open Image Denoise, guided by albedo and normals": "Entfernt nach dem letzten "
    "Durchgang das restliche Rauschen mit Intel Open Image Denoise, geleitet von Albedo und Normalen",
    "The same seed gives the same noise on any number of threads; another seed gives an independent render": "Derselbe Startwert gibt auf "
    "beliebig vielen Threads dasselbe Rauschen; ein anderer gibt ein unabhängiges Bild",
    "Every frame gets noise and photons of its own, derived from the seed; off, noise stands still in an animation": "Jedes Einzelbild "
    "bekommt eigenes Rauschen und eigene Photonen aus dem Startwert; ausgeschaltet steht das Rauschen in einer Animation still",
    "Number of the first pass to render: passes 9 to 16 are rendered with First Pass 9 and 8 passes. Machines that render different passes "
    "of one picture are merged by opal.merge": "Nummer des ersten Durchgangs: Die Durchgänge 9 bis 16 entstehen mit dem ersten Durchgang 9 "
    "und 8 Durchgängen. Was mehrere Rechner zu einem Bild beitragen, vereint opal.merge",
    "Writes the film's exact sums beside the picture, to be merged with other passes of the same picture": "Schreibt neben dem Bild die "
    "genauen Summen des Films, um sie mit anderen Durchgängen desselben Bildes zu vereinen",
    "Where the film is written; # stands for a digit of the frame number. The passes are added to the name": "Wohin der Film geschrieben "
    "wird; # steht für eine Ziffer der Bildnummer. Die Durchgänge werden an den Namen gehängt",
    "After how many seconds the render ends, to the nearest whole pass; 0 sets no limit": "Nach wie vielen Sekunden das Rendern endet, "
    "auf den nächsten ganzen Durchgang genau; 0 setzt keine Grenze",
    "The render ends once the estimated error of brightness, averaged over the picture and relative to it, falls below this; 0 renders all "
    "passes": "Das Rendern endet, sobald der geschätzte Helligkeitsfehler, über das Bild gemittelt und auf es bezogen, darunter fällt; 0 "
    "rechnet alle Durchgänge",
    "Factor on the brightness of every pixel": "Faktor auf die Helligkeit jedes Pixels",
    "How neighbouring samples are weighted into a pixel": "Wie benachbarte Abtastungen in ein Pixel eingehen",
    "Width of the pixel filter in pixels": "Breite des Pixelfilters in Pixeln",
    "Largest value that one sample of direct light may add to a pixel; 0 does not clamp, which alone is right": "Größter Wert, den eine "
    "Abtastung direkten Lichts zu einem Pixel beitragen darf; 0 begrenzt nicht, und nur das ist richtig",
    "Largest value that one sample of indirect light may add to a pixel; 0 does not clamp, which alone is right": "Größter Wert, den eine "
    "Abtastung indirekten Lichts zu einem Pixel beitragen darf; 0 begrenzt nicht, und nur das ist richtig",
    "Writes the radiance at each wavelength beside the picture, as a spectral OpenEXR file (layout of Fichet et al. 2021)": "Schreibt neben "
    "dem Bild die Strahldichte jeder Wellenlänge als spektrale OpenEXR-Datei (Aufbau nach Fichet et al. 2021)",
    "Where the spectral file is written; # stands for a digit of the frame number": "Wohin die spektrale Datei geschrieben wird; # steht "
    "für eine Ziffer der Bildnummer",
    "How many equal parts the range of wavelengths is divided into for the spectral file": "In wie viele gleiche Teile der Bereich der "
    "Wellenlängen für die spektrale Datei geteilt wird",
    # Passes of a view layer
    "Keeps the share of white light that surfaces send back, for denoisers and compositing": "Behält den Anteil weißen Lichts, den "
    "Oberflächen zurückwerfen, zum Entrauschen und Zusammensetzen",
    "Keeps light that met one surface between its source and the camera": "Behält Licht, das zwischen Quelle und Kamera eine Oberfläche traf",
    "Keeps light that met more than one surface, without caustics": "Behält Licht, das mehr als eine Oberfläche traf, ohne Kaustiken",
    "Keeps light that reached a diffuse surface through a gem or glass or off a mirror": "Behält Licht, das eine matte Oberfläche durch "
    "Edelstein oder Glas oder über einen Spiegel erreichte",
    "Keeps light that a medium or a rainbow scattered or gave off towards the camera": "Behält Licht, das ein Medium oder ein Regenbogen zur "
    "Kamera streute oder aussandte",
    # Materials and gems
    "What the material is": "Was das Material ist",
    "What the material's node tree says": "Was der Node-Baum des Materials sagt",
    "A transparent body that splits and absorbs light: a stone, glass or a liquid": "Ein durchsichtiger Körper, der Licht zerlegt und "
    "absorbiert: ein Stein, Glas oder eine Flüssigkeit",
    "Fills a closed body with fog, smoke or milk": "Füllt einen geschlossenen Körper mit Nebel, Rauch oder Milch",
    "Fills a closed body with water drops, which show a bow opposite the sun": "Füllt einen geschlossenen Körper mit Wassertropfen, die der "
    "Sonne gegenüber einen Bogen zeigen",
    "Fills the gem with a medium: milky opal, clouded quartz": "Füllt den Edelstein mit einem Medium: milchiger Opal, trüber Quarz",
    "The stone; choosing one fills the settings below, editing those makes it Custom": "Der Stein; die Wahl füllt die Einstellungen darunter "
    "aus, und wer diese ändert, macht ihn zu einem eigenen",
    "Formula of the index of refraction against wavelength": "Formel der Brechzahl über der Wellenlänge",
    "Cauchy's B: the index of refraction at very long wavelengths": "Cauchys B: die Brechzahl bei sehr großen Wellenlängen",
    "Cauchy's C in square micrometres: how strongly the index rises towards violet": "Cauchys C in Quadratmikrometern: wie stark die "
    "Brechzahl zum Violett hin steigt",
    "Sellmeier's B: the strengths of three resonances": "Sellmeiers B: die Stärken dreier Resonanzen",
    "Sellmeier's C in square micrometres: the squared wavelengths of three resonances": "Sellmeiers C in Quadratmikrometern: die Quadrate der "
    "Wellenlängen dreier Resonanzen",
    "How much the boundary reflects": "Wie viel die Grenzfläche spiegelt",
    "What says how the stone absorbs light": "Was sagt, wie der Stein Licht absorbiert",
    "What white light becomes along the absorption depth": "Was aus weißem Licht entlang der Absorptionstiefe wird",
    "Length of stone after which white light has the absorption color": "Länge im Stein, nach der weißes Licht die Absorptionsfarbe hat",
    "Samples of absorption against wavelength, straight between them and level outside": "Stützstellen der Absorption über der Wellenlänge, "
    "dazwischen gerade und außerhalb waagerecht",
    "Wavelength of the sample in nanometres": "Wellenlänge der Stützstelle in Nanometern",
    "Absorption at this wavelength per millimetre: light falls to exp(-absorption × millimetres)": "Absorption bei dieser Wellenlänge je "
    "Millimeter: Licht fällt auf exp(-Absorption × Millimeter)",
    "Roughness of the surface: 0 is polished, 1 is fully frosted": "Rauheit der Oberfläche: 0 ist poliert, 1 ganz mattiert",
    "Where two stones or liquids overlap, the one of higher priority fills the place": "Wo zwei Steine oder Flüssigkeiten sich überlappen, "
    "füllt die mit dem höheren Vorrang die Stelle",
    # Media
    "Fills in the numbers of a known medium; they can be edited afterwards": "Trägt die Zahlen eines bekannten Mediums ein; sie lassen sich "
    "danach ändern",
    "How much light the medium takes out of a beam in each metre, by absorption and scattering together": "Wie viel Licht das Medium je "
    "Meter durch Absorption und Streuung zusammen aus einem Strahl nimmt",
    "How the extinction depends on colour: a factor a channel. White takes all colours alike; blue lets red pass": "Wie die Extinktion von "
    "der Farbe abhängt: ein Faktor je Kanal. Weiß nimmt alle Farben gleich, Blau lässt Rot durch",
    "Which part of the light taken is scattered on, by colour; the rest is absorbed": "Welcher Teil des genommenen Lichts weitergestreut "
    "wird, nach Farbe; der Rest wird absorbiert",
    "Into which directions light is scattered": "In welche Richtungen Licht gestreut wird",
    "Mean cosine of the angle by which light is turned: 0 is even, near 1 is straight on, below 0 is back": "Mittlerer Kosinus des Winkels, "
    "um den Licht abgelenkt wird: 0 ist gleichmäßig, nahe 1 geradeaus, unter 0 zurück",
    "Where the medium is dense and where it is thin; extinction and emission are multiplied by it": "Wo das Medium dicht und wo es dünn ist; "
    "Extinktion und Emission werden damit malgenommen",
    "Name of the grid that says the density; a missing grid is named in the report and renders as nothing": "Name des Gitters, das die "
    "Dichte sagt; ein fehlendes Gitter steht im Bericht und wird als leer berechnet",
    "Size of the largest lumps, in the object's own space": "Größe der größten Klumpen im Raum des Objekts",
    "How many octaves of finer lumps are added, each half as large and half as strong": "Wie viele Oktaven feinerer Klumpen dazukommen, jede "
    "halb so groß und halb so stark",
    "0 is even, at half of the extinction; higher values part the medium into empty space and full density": "0 ist gleichmäßig mit halber "
    "Extinktion; höhere Werte teilen das Medium in leeren Raum und volle Dichte",
    "Another seed gives other clouds": "Ein anderer Startwert gibt andere Wolken",
    "What the medium's own light looks like": "Wie das eigene Licht des Mediums aussieht",
    "Temperature whose light a blackbody sends": "Temperatur, deren Licht ein schwarzer Körper aussendet",
    "Name of a grid that the emission is multiplied by, such as flame; empty: the density": "Name eines Gitters, mit dem die Emission "
    "malgenommen wird, etwa flame; leer: die Dichte",
    "Colour of the medium's own light": "Farbe des eigenen Lichts des Mediums",
    "Radiance that each metre of the medium adds by itself": "Strahldichte, die jeder Meter des Mediums von sich aus beiträgt",
    # World
    "What fills the whole world, outside of every object": "Was die ganze Welt außerhalb aller Objekte füllt",
    "Empty space, or what the Volume socket of the world's node tree says": "Leerer Raum, oder was der Volumen-Eingang des Node-Baums der "
    "Welt sagt",
    "Haze or fog everywhere": "Überall Dunst oder Nebel",
    "Water drops everywhere: rain to the horizon": "Überall Wassertropfen: Regen bis zum Horizont",
    "Height over which the density falls to 37 %; 0 keeps it to infinity, where no sun and no sky shines through": "Höhe, über die die "
    "Dichte auf 37 % fällt; 0 behält sie bis ins Unendliche, wo weder Sonne noch Himmel durchscheinen",
    "Height from which on the density falls; below it stays as it is, down to the ground under everything in the scene": "Höhe, von der an "
    "die Dichte fällt; darunter bleibt sie, wie sie ist, bis zum Boden unter allem in der Szene",
    # Rainbows
    "Fills in the drops of a known bow; they can be edited afterwards": "Trägt die Tropfen eines bekannten Bogens ein; sie lassen sich danach "
    "ändern",
    "How the light that drops scatter is computed": "Wie das Licht berechnet wird, das Tropfen streuen",
    "Mean radius of the drops in millimetres: large drops give narrow, bright colours, fog an almost white bow": "Mittlerer Radius der "
    "Tropfen in Millimetern: Große Tropfen geben schmale, kräftige Farben, Nebel einen fast weißen Bogen",
    "How the drops' radii are distributed about the mean": "Wie die Radien der Tropfen um den Mittelwert verteilt sind",
    "Width of the distribution of radii relative to the mean; supernumerary arcs need narrow ones": "Breite der Verteilung der Radien, "
    "bezogen auf den Mittelwert; überzählige Bögen brauchen schmale",
    "How much light the drops take out of a beam in each metre by their discs' area: heavy rain has about 0.001": "Wie viel Licht die Tropfen "
    "je Meter mit der Fläche ihrer Scheiben aus einem Strahl nehmen: starker Regen hat etwa 0,001",
    "What the drops are made of": "Woraus die Tropfen bestehen",
    "Of the water in degrees Celsius: warm drops have a slightly larger bow": "Des Wassers in Grad Celsius: Warme Tropfen haben einen etwas "
    "größeren Bogen",
    "Salt in parts per thousand of the sea water's mass; the oceans have 35": "Salz in Tausendsteln der Masse des Meerwassers; die Ozeane "
    "haben 35",
    "Index of refraction of the other liquid relative to air, at the sodium line (589.3 nm)": "Brechzahl der anderen Flüssigkeit gegen Luft "
    "bei der Natriumlinie (589,3 nm)",
    "How much the other liquid splits colours: Cauchy's second coefficient in µm²; water has 0.003, crown glass 0.004": "Wie sehr die andere "
    "Flüssigkeit Farben zerlegt: Cauchys zweiter Koeffizient in µm²; Wasser hat 0,003, Kronglas 0,004",
    "Keeps the light that drops diffract forward, half of all: it makes the corona close round the sun and much noise. Without it that "
    "light goes straight on": "Behält das Licht, das Tropfen nach vorn beugen, die Hälfte von allem: Es macht den Hof dicht um die Sonne und "
    "viel Rauschen. Ohne das geht dieses Licht geradeaus",
    "How far drops take the shape that falling gives them: 0 are spheres, 1 is full; used by the theory Droplet alone": "Wie weit Tropfen die "
    "Form annehmen, die ihnen der Fall gibt: 0 sind Kugeln, 1 ist ganz; nur für die Theorie Tropfen",
    "The bow's light is polarised along the bow, as a camera with a polarising filter sees it": "Das Licht des Bogens ist entlang des Bogens "
    "polarisiert, wie es eine Kamera mit Polarisationsfilter sieht",
    # Cameras and lamps
    "A linear polarising filter before the lens; it takes half of unpolarised light and can make a rainbow vanish": "Ein linearer "
    "Polarisationsfilter vor der Linse; er nimmt die Hälfte des unpolarisierten Lichts und kann einen Regenbogen verschwinden lassen",
    "Direction of the light's field that passes, from the camera's horizontal: 0 keeps the top of a bow, 90 degrees takes it away": "Richtung "
    "des Feldes, das durchgeht, von der Waagerechten der Kamera aus: 0 behält den Scheitel eines Bogens, 90 Grad nimmt ihn weg",
    "What the lamp's light is made of. A lamp with a spectrum is as bright as a white lamp of the same power; the lamp's color filters it": "Woraus "
    "das Licht der Lampe besteht. Eine Lampe mit einem Spektrum ist so hell wie eine weiße gleicher Leistung; die Farbe der Lampe filtert es",
    "Temperature of the black body in kelvin: a candle has 1900, a filament 2800, the sun 5800": "Temperatur des schwarzen Körpers in Kelvin: "
    "eine Kerze hat 1900, ein Glühfaden 2800, die Sonne 5800",
    "Wavelength of the laser in nanometres": "Wellenlänge des Lasers in Nanometern",
    # Operators
    "Add a curtain of rain where the scene's camera looks away from the sun, so that it shows a rainbow": "Fügt einen Vorhang aus Regen dort "
    "ein, wo die Kamera der Szene von der Sonne wegblickt, sodass er einen Regenbogen zeigt",
    "Add a cut stone of real size and give it the material of a gem": "Fügt einen geschliffenen Stein in wirklicher Größe ein und gibt ihm "
    "das Material eines Edelsteins",
    "Cut a stone after the instructions of a GemCad file (.asc)": "Schleift einen Stein nach den Anweisungen einer GemCad-Datei (.asc)",
    "Read how the stone absorbs from a text file: a wavelength in nm and an absorption in 1/mm on each line": "Liest aus einer Textdatei, wie "
    "der Stein absorbiert: in jeder Zeile eine Wellenlänge in nm und eine Absorption in 1/mm",
    "Draw the bows of all five theories without a scene: strips and Lee diagrams in true colour, curves of luminance and polarisation, and "
    "the errors against Lorenz-Mie theory in numbers": "Zeichnet die Bögen aller fünf Theorien ohne Szene: Streifen und Lee-Diagramme in "
    "wahren Farben, Kurven der Leuchtdichte und Polarisation, und die Fehler gegen die Lorenz-Mie-Theorie in Zahlen",
    "Make the node trees that Cycles and EEVEE show follow Opal's settings; trees that were edited by hand are left alone": "Lässt die "
    "Node-Bäume, die Cycles und EEVEE zeigen, Opals Einstellungen folgen; von Hand bearbeitete Bäume bleiben unberührt",
    "Merge films of different passes of the same picture: passes 1 to 8 and 9 to 16 make the picture of 1 to 16, exactly": "Vereint Filme "
    "verschiedener Durchgänge desselben Bildes: 1 bis 8 und 9 bis 16 geben genau das Bild von 1 bis 16",
    "Render Opal's layers of this frame into images, to be laid over a picture by another engine": "Rendert Opals Ebenen dieses Einzelbilds "
    "in Bilder, die über das Bild einer anderen Engine gelegt werden",
    "Render this frame by Cycles without caustics and without what Opal renders better, and lay Opal's layers over it": "Rendert dieses "
    "Einzelbild mit Cycles ohne Kaustiken und ohne das, was Opal besser rendert, und legt Opals Ebenen darüber",
    "Render this frame by both engines with the same camera and light, Opal's materials by their twins, and measure the difference": "Rendert "
    "dieses Einzelbild mit beiden Engines bei gleicher Kamera und gleichem Licht, Opals Materialien durch ihre Zwillinge, und misst den "
    "Unterschied",
    "Render the active stone face-up under a bright hemisphere with the shadow of the observer's head, and measure its light return, fire, "
    "leakage and tilt curve; the stone looks up along its own Z axis": "Rendert den aktiven Stein von oben unter einer hellen Halbkugel mit "
    "dem Schatten des Betrachterkopfs und misst Lichtrückgabe, Feuer, Lichtverlust und Kippkurve; der Stein blickt entlang seiner Z-Achse",
    "Select the objects that a line of the last render's report is about; for a material, image or lamp, those that use it": "Wählt die "
    "Objekte aus, von denen eine Zeile des Berichts über das letzte Rendern handelt; bei Material, Bild oder Lampe die, die sie verwenden",
}

OPERATORS = {
    "Absorption of a Gem (.csv)": "Absorption eines Edelsteins (.csv)",
    "Add Render Preset": "Rendervorgabe hinzufügen",
    "Apply Material Preset": "Materialvorgabe anwenden",
    "Apply Render Preset": "Rendervorgabe anwenden",
    "Remove Render Preset": "Rendervorgabe entfernen",
    "Compare with Cycles": "Mit Cycles vergleichen",
    "Composite over Cycles": "Über Cycles zusammensetzen",
    "Gem": "Edelstein",
    "Gem Report": "Edelsteinbericht",
    "GemCad (.asc)": "GemCad (.asc)",
    "Import Absorption": "Absorption importieren",
    "Import GemCad": "GemCad importieren",
    "Merge Films": "Filme vereinen",
    "Rain": "Regen",
    "Rainbow Chart": "Regenbogentafel",
    "Render Layers": "Ebenen rendern",
    "Scene": "Szene",
    "Select Reported": "Gemeldetes auswählen",
    "Update Twins": "Zwillinge nachführen",
    "Volumes": "Volumen",
}
