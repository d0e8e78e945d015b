"""Feedback in French."""

from __future__ import annotations

from collections.abc import Mapping

FRENCH: Mapping[str, str] = {
    # Verdicts
    "correct": "Correct.",
    "incorrect": "Incorrect.",
    "missing-unit": "Il manque l'unité.",
    "not-gradable": "Cette réponse ne peut pas être notée : la tolérance est plus fine que la précision de la "
    "valeur de référence.",
    "unreadable": "Cette réponse est illisible.",
    "figure-unknown": "Impossible d'évaluer : la question n'a pas cette grandeur. Signalez-le à l'équipe du cours.",
    "carried": "Ce n'est pas la valeur attendue, mais le calcul est cohérent avec votre résultat précédent.",
    "several": "Chacune des erreurs suivantes conduit à cette valeur.",
    "sensitive": "Comparez {name} : la valeur elle-même est si proche d'une constante que l'erreur ne s'y voit guère.",
    # Units
    "unit-malformed": "Écrivez l'unité comme un produit de puissances d'unités, par exemple kg m^2/s^2.",
    "unit-unknown": "Cette unité est inconnue.",
    "unit-other-kind": "Cette unité correspond à une autre grandeur.",
    "unit-millisecond": "Cette unité correspond à une autre grandeur : ms désigne la milliseconde ; le mètre par "
    "seconde s'écrit m/s.",
    "unit-with-offset": "Utilisez une unité dont l'échelle part de zéro.",
    "unit-size": "Cette unité est trop grande ou trop petite.",
    # Entries that cannot be read
    "direction-in-words": "Indiquez le sens par le signe du nombre, pas par des mots.",
    "entry-empty": "La réponse est vide.",
    "entry-malformed": "Écrivez un nombre avec son unité, par exemple 6,28 s.",
    "number-ambiguous": "{digits} peut signifier {whole} ou {decimal}. Écrivez {whole} ou {padded}.",
    "number-malformed": "Écrivez le nombre avec un seul séparateur décimal et, si vous séparez les milliers, par "
    "groupes de trois chiffres.",
    "number-or-range": "{entry} peut être un calcul, un intervalle ou une valeur avec son incertitude. Écrivez le "
    "résultat sous la forme d'un seul nombre.",
    "power-of-ten": "Écrivez les puissances de dix avec ^, par exemple 2*10^-3.",
    "quotient-unclear": "Mettez des parenthèses : 1/2π peut signifier 1/(2π) ou (1/2)π.",
    "list-malformed": "Écrivez une liste de nombres, par exemple [1,5; 2; 3].",
    "name-unknown": "L'énoncé ne contient aucune grandeur nommée « {name} ». Les noms sont : {names}.",
    "name-from-zero": "L'énoncé ne contient aucune grandeur nommée « {name} » : la numérotation commence à 1. Les "
    "noms sont : {names}.",
    "formula-malformed": "La formule est incomplète ou contient un signe non admis. Écrivez * entre les facteurs.",
    "formula-not-expected": "Une formule n'est pas possible ici : la réponse n'est pas un nombre.",
    "form-number": "Donnez un seul nombre.",
    "form-word": "Donnez l'un des mots de l'énoncé, ou true ou false.",
    "form-list": "Donnez une liste de {count} nombres.",
    "form-rows": "Donnez {rows} lignes de {count} nombres.",
    # Formulas
    "formula-undefined": "La formule n'a pas de valeur pour de tels nombres : vérifiez les divisions, les racines "
    "et les logarithmes.",
    "formula-not-judged": "Une formule ne peut pas être notée ici. Donnez le nombre avec son unité.",
    "formula-at-one-place": "La formule donne la bonne valeur pour ces nombres, mais pas pour d'autres.",
    "dimension": "Vérifiez les dimensions : la formule n'a pas la dimension de la grandeur cherchée.",
    "dimension-terms": "Vérifiez les dimensions : on n'additionne et ne soustrait que des grandeurs de même dimension.",
    "dimension-function": "Vérifiez les dimensions : l'argument d'une fonction telle que sin ou exp est un nombre "
    "sans dimension.",
    "dimension-exponent": "Vérifiez les dimensions : un exposant est un nombre sans dimension.",
    # Samples
    "samples-until": "Les échantillons sont corrects jusqu'à t = {until:.3g} s.",
    "samples-separatrix": "Les échantillons sont corrects jusqu'à t = {until:.3g} s. Ils se perdent ensuite à la "
    "séparatrice : à partir de t = {crossed:.3g} s, ils tournent autour d'un autre axe.",
    "samples-of-solver": "Les échantillons proviennent d'une méthode adaptative ({method}) de tolérance "
    "{tolerance:.0e}.",
    "samples-of-method": "Les échantillons proviennent de la méthode {method} avec un pas de {step:.6g} s.",
    "samples-rounded": "Les échantillons sont corrects pour les chiffres donnés, mais la tolérance en exige davantage.",
    "axes-exchanged": "Les axes {one} et {other} sont échangés.",
    "axes-order": "Les axes sont dans l'ordre {order}.",
    # Mistakes in any quantity
    "sign": "La valeur absolue est juste. Vérifiez le signe et le sens compté positivement.",
    "factor-2": "Trop grand d'un facteur 2.",
    "factor-half": "Trop petit d'un facteur 2.",
    "factor-2-pi": "Trop grand d'un facteur 2π : distinguez les radians des tours, et la pulsation de la fréquence.",
    "factor-1-over-2-pi": "Trop petit d'un facteur 2π : distinguez les radians des tours, et la pulsation de la "
    "fréquence.",
    "degrees": "Votre valeur est en degrés. Donnez-la en radians, ou précisez l'unité.",
    "rpm": "Votre valeur est en tours par minute. Donnez-la en rad/s, ou précisez l'unité.",
    "factor-1000": "Erreur d'un facteur 1000 : vérifiez les préfixes des unités.",
    "squared": "Vous avez donné le carré de la grandeur.",
    "root": "Vous avez donné la racine carrée de la grandeur.",
    "reciprocal": "Vous avez donné l'inverse de la grandeur. Une période, par exemple, est l'inverse d'une fréquence.",
    "permuted-axes": "Les composantes sont justes, mais dans un autre ordre. Conservez les axes dans lesquels le "
    "solide est donné.",
    "transposed-rotation": "C'est la rotation inverse. La rotation doit faire passer des axes du solide aux axes de "
    "l'espace.",
    "scalar-last": "La partie scalaire du quaternion se place ici en premier.",
    # Mass and inertia
    "inertia-about-another-point": "Les moments d'inertie se rapportent à un autre point. Un solide libre tourne "
    "autour de son centre de masse, où que soit l'origine.",
    "parallel-axis": "Vérifiez le théorème de Huygens : son terme s'ajoute une seule fois lorsqu'on passe du centre "
    "de masse à un autre point.",
    "products-of-inertia-sign": "Vérifiez les signes hors de la diagonale : I_xy est l'opposé de l'intégrale de x y "
    "dm.",
    "repeated-points-dropped": "Chaque masse ponctuelle compte, même lorsque deux d'entre elles coïncident.",
    "shell-for-solid": "Vérifiez la forme : le solide est-il plein, ou est-ce une coque mince dont la masse est "
    "loin de l'axe ?",
    "diameter-for-radius": "Vérifiez pour chaque longueur s'il s'agit d'un rayon ou d'un diamètre.",
    # Rotation
    "space-axes": "Ce sont les composantes dans les axes de l'espace. Les équations d'Euler portent sur les "
    "composantes dans les axes du solide.",
    "samples-off-by-one": "Les échantillons sont justes, mais décalés d'un pas de temps.",
    "samples-rate-over-axial-moment": "La vitesse de précession est fausse : vous avez divisé la différence des "
    "moments d'inertie par le moment axial au lieu du moment transversal.",
    "time-scaled": "Le mouvement est juste, mais trop rapide ou trop lent. Vérifiez l'unité de temps et les "
    "facteurs de la vitesse.",
    "period-for-flip-interval": "Distinguez la période de l'intervalle entre deux basculements : un basculement "
    "dure une demi-période.",
    "body-for-space-rate": "Distinguez deux vitesses de précession : celle de la vitesse angulaire dans le solide "
    "et celle de l'axe du solide dans l'espace.",
    "cones-exchanged": "Vérifiez entre quelles directions se trouve l'angle : la vitesse angulaire et le moment "
    "cinétique n'ont pas la même direction.",
    "rate-over-axial-moment": "Divisez la différence des moments d'inertie par le moment transversal, comme le "
    "montrent les équations d'Euler pour les composantes transversales.",
    "moments-exchanged": "Vérifiez quel moment d'inertie correspond à l'axe de symétrie.",
    "symmetric-formula": "Vous avez utilisé la formule d'un solide symétrique, mais les trois moments d'inertie "
    "sont différents.",
    "ellipticity-root-of-moments": "Le rapport des axes n'est pas la racine carrée du rapport des moments "
    "d'inertie, qui sont proportionnels à 2a² et à a² + c².",
    "ellipticity-quotient-of-moments": "Le rapport des axes est la racine carrée de (1 + e)/(1 - e), où e est la "
    "différence relative des moments d'inertie.",
    "flattening-for-asymmetry": "Distinguez l'aplatissement, qui décrit la forme, de l'asymétrie des moments "
    "d'inertie.",
    "solar-for-sidereal-day": "Distinguez le jour solaire du jour sidéral : la Terre fait un tour en un jour sidéral.",
    "extreme-axis-unstable": "La rotation autour de l'axe du plus grand ou du plus petit moment d'inertie est "
    "stable : une petite perturbation reste petite.",
    "middle-axis-stable": "La rotation autour de l'axe du moment d'inertie intermédiaire est instable : une petite "
    "perturbation croît.",
    "real-for-imaginary": "Vérifiez le signe du carré : il détermine si les valeurs propres sont réelles ou "
    "imaginaires.",
    "euler-second-equation": "Vérifiez les signes : les équations d'Euler se déduisent l'une de l'autre par "
    "permutation circulaire de 1, 2 et 3.",
    "derivative-for-state": "La méthode d'Euler ajoute à la valeur précédente le produit du pas et de la dérivée.",
    "step-left-out": "La dérivée doit être multipliée par le pas.",
    # Scenes
    "inertia-left-out": "Tenez compte des moments d'inertie : une poulie massive a des tensions différentes de "
    "chaque côté, et un solide qui roule avance moins vite qu'un solide qui glisse.",
    "shafts-do-not-turn": "Les cylindres tournent pendant que le fil se déroule, ce qui absorbe une partie du "
    "travail de la pesanteur.",
    "hoop-for-solid-shaft": "Vérifiez le moment d'inertie des cylindres : cylindre plein ou tube mince ?",
    "rod-inertia-about-end": "M l²/3 est le moment d'inertie par rapport à une extrémité de la tige. Partez du "
    "moment par rapport à son centre et utilisez le théorème de Huygens.",
    "rod-depth-and-inertia": "Vérifiez les dimensions de l'énergie potentielle, les triangles semblables qui "
    "donnent la profondeur du centre au lâcher, et le point par rapport auquel vous prenez le moment d'inertie.",
    "rod-depth": "Vérifiez les dimensions de l'énergie potentielle et les triangles semblables qui donnent la "
    "profondeur du centre.",
    "rod-without-own-rotation": "La tige tourne aussi pendant que son centre oscille : tenez compte de son propre "
    "moment d'inertie.",
    "masses-exchanged": "Vérifiez de quel côté se trouve chaque masse.",
    "sine-for-cosine": "Vérifiez la composante du poids le long de chaque pente, et à partir de quelle droite "
    "l'angle est mesuré.",
    "calculator-in-radians": "Les sinus ne correspondent pas à ces angles. Votre calculatrice est-elle réglée en "
    "radians au lieu de degrés ?",
    "without-gravity": "Vérifiez les dimensions : il manque l'accélération de la pesanteur.",
}
